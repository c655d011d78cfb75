// `myriad convert IN OUT.glb`: what people have on disk, as the one format that Myriad renders.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>

#include "engine/error.hpp"
#include "scenes/gltf/write.hpp"
#include "scenes/import/import.hpp"
#include "tools/arguments.hpp"
#include "tools/commands.hpp"
#include "tools/message.hpp"
#include "tools/output_file.hpp"
#include "tools/progress.hpp"

namespace myriad::tools {
namespace {

using scenes::Scene;

struct Options {
    std::string in, out;
    scenes::ImportOptions import;
    uint32_t seed = 1;
    bool quiet = false;
};

double parse_unit(const std::string& text) {
    for (const auto& [name, metres] : {std::pair("mm", 1e-3), {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}, {"ft", 0.3048}})
        if (text == name) return metres;
    double metres = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), metres);
    if (error == std::errc() && end == text.data() + text.size() && metres >= 1e-9 && metres <= 1e9) return metres;
    throw InputError("--unit '" + text + "': give mm, cm, m, in, ft, or the metres a unit as a number from 1e-9 to 1e9");
}

std::string counted(size_t count, const char* what, const char* more = "s") {
    return std::to_string(count) + " " + what + (count == 1 ? "" : more);
}

// The bounds of all instances, by their meshes' boxes: what a wrong unit shows in.
glm::dvec3 extent(const Scene& scene) {
    glm::dvec3 lo(1e300), hi(-1e300);
    for (const auto& mesh : scene.meshes) {
        glm::dvec3 a(1e300), b(-1e300);
        for (const auto& primitive : mesh.primitives)
            for (const auto& p : primitive.positions) a = glm::min(a, glm::dvec3(p)), b = glm::max(b, glm::dvec3(p));
        if (a.x > b.x) continue;
        for (const auto& instance : scene.instances) {
            if (&scene.meshes[instance.mesh] != &mesh) continue;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec4 at(corner & 1 ? a.x : b.x, corner & 2 ? a.y : b.y, corner & 4 ? a.z : b.z, 1);
                const glm::dvec3 p(glm::dmat4(instance.to_world) * at);
                lo = glm::min(lo, p), hi = glm::max(hi, p);
            }
        }
    }
    return lo.x > hi.x ? glm::dvec3(0) : hi - lo;
}

void summarise(const Scene& scene, const std::string& path, size_t bytes) {
    size_t once = 0, shown = 0;
    std::vector<size_t> triangles;
    for (const auto& mesh : scene.meshes) {
        triangles.push_back(0);
        for (const auto& primitive : mesh.primitives) triangles.back() += primitive.indices.size() / 3;
        once += triangles.back();
    }
    for (const auto& instance : scene.instances) shown += triangles[instance.mesh];
    const glm::dvec3 size = extent(scene);
    std::printf("%s: %.1f MiB; %s%s in %s and %s; %s, %s; %s, %s; %.3g x %.3g x %.3g m\n", path.c_str(), double(bytes) / (1 << 20),
                counted(once, "triangle").c_str(), shown == once ? "" : (" (" + std::to_string(shown) + " with instances)").c_str(),
                counted(scene.meshes.size(), "mesh", "es").c_str(), counted(scene.instances.size(), "instance").c_str(),
                counted(scene.materials.size(), "material").c_str(), counted(scene.textures.size(), "texture").c_str(),
                counted(scene.cameras.size(), "camera").c_str(), counted(scene.lights.size(), "light").c_str(), size.x, size.y, size.z);
}

void run(const Options& options) {
    if (!options.out.ends_with(".glb")) throw InputError(options.out + ": convert writes .glb files only; let the name end in .glb");
    require_writable(options.out);
    Progress progress(options.quiet);
    progress.show("reading", 0);
    const Scene scene = scenes::import_scene(options.in, options.import, options.seed);
    progress.clear();
    for (const std::string& warning : scene.warnings) say("warning", warning);
    if (scene.instances.empty()) throw InputError(options.in + ": there is nothing in it that could be rendered; give a file with triangles");
    progress.show("writing", 0.5);
    OutputFile file(options.out);
    size_t size = 0;
    scenes::write_glb(scene, [&](const void* bytes, size_t count) { file.write(bytes, count), size += count; });
    file.commit();
    progress.clear();
    if (!options.quiet) summarise(scene, options.out, size);
}

std::string footer() {
    std::string text = "Reads:\n";
    size_t width = 12;
    std::vector<std::string> endings;
    for (const scenes::Format& format : scenes::formats()) {
        endings.push_back(CLI::detail::join(format.endings, " "));
        width = std::max(width, endings.back().size());
    }
    for (size_t i = 0; i < endings.size(); ++i)
        text += "  " + endings[i] + std::string(width + 2 - endings[i].size(), ' ') + scenes::formats()[i].name + "\n";
    return text +
           "  builtin:NAME" + std::string(width - 10, ' ') + "a built-in scene, see render -h\n"
           "The result is one self-contained file in metres, +Y up, the same bytes for the same input. Harmless defects are\n"
           "repaired and counted in warnings. The last line tells the size in metres: a wrong --unit shows there.";
}

}  // namespace

void add_convert(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("convert", "Other formats as .glb, which is what Myriad renders");
    command->add_option("IN", options->in, "the scene to read; FILE#NAME or FILE#INDEX for another scene of a glTF file than its default")->required();
    command->add_option("OUT", options->out, "the file to write, .glb")->required();
    add_parsed(*command, "--unit", "UNIT", "", "a unit of length in IN: mm, cm, m, in, ft, or metres a unit; else what IN says or its format means",
               [options](const std::string& text) { options->import.unit = parse_unit(text); });
    add_parsed(*command, "--up", "x|y|z", "", "the axis of IN that points up; else what IN says or its format means", [options](const std::string& text) {
        if (text != "x" && text != "y" && text != "z") refuse_choice("--up", text, {"x", "y", "z"});
        options->import.up = scenes::Axis(text[0] - 'x');
    });
    add_parsed(*command, "--crease", "DEGREES", "", "where IN has no normals: edges that turn less are smoothed, 0 for none; else by format",
               [options](const std::string& text) { options->import.crease = parse_number("--crease", text, 0, 180); });
    add_choice(*command, "--colors", options->import.linear_colors, {{"srgb", false}, {"linear", true}},
               "what colours of materials and vertices in IN are; glTF's are linear always");
    add_whole(*command, "--seed", options->seed, 0, UINT32_MAX, "for built-in scenes");
    command->add_flag("-q,--quiet", options->quiet, "only warnings and errors");
    command->footer(footer());
    command->callback([options] { run(*options); });
}

}  // namespace myriad::tools
