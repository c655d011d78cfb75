#include "tools/bench/maps_bench.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>

#include "scenes/sky.hpp"
#include "tools/metrics.hpp"
#include "tools/render_options.hpp"

namespace myriad::tools {

using passes::CutUpdate;
using passes::Visibility;

passes::FrameSettings frame_settings(const BenchOptions& options, uint32_t views) {
    passes::FrameSettings settings;
    settings.width = 320, settings.height = 180;
    settings.vpls = views;
    settings.seed = options.seed;
    settings.log2_samples = options.log2_samples;
    settings.maps.map_size = options.map_size;
    settings.maps.epsilon = options.epsilon;
    settings.maps.arity = options.arity;
    return settings;
}

StillScene::StillScene(const BenchOptions& options, const std::string& otherwise)
    : source(options.scene.empty() ? otherwise : options.scene), scene(scenes::load(source, options.seed)) {
    scenes::apply_sky(scene, scenes::SkyChoice::automatic);
    triangles = scenes::flatten(scene);
    camera = scenes::pick_camera(scene, triangles, options.camera);
}

std::string StillScene::name() const { return std::filesystem::path(source).filename().string(); }

Turntable load_turntable(const BenchOptions& options) {
    Turntable table;
    table.source = options.scene.empty() ? "builtin:hairball" : options.scene;
    table.scene = scenes::load(table.source, options.seed);
    for (scenes::Material& m : table.scene.materials) m.emissive = glm::vec3(0);  // all light comes from what moves
    scenes::apply_sky(table.scene, scenes::SkyChoice::automatic);
    table.triangles = scenes::flatten(table.scene);
    if (table.scene.lights.empty()) throw InputError("\"" + table.source + "\" has no punctual light to move; give another --scene");
    table.camera = scenes::pick_camera(table.scene, table.triangles, options.camera);
    std::printf("scene: %s, %zu triangles, 2^%u samples, maps 2 x %u^2, epsilon %g\n", table.source.c_str(), size_t(table.triangles.count()),
                options.log2_samples, options.map_size, options.epsilon);
    return table;
}

scenes::Moment Turntable::at(double degrees) const {
    scenes::Moment moment = scenes::moment_at(scene, triangles.motion, 0);
    const double a = degrees * 3.14159265358979323846 / 180;
    const glm::dmat3 turn(std::cos(a), 0, -std::sin(a), 0, 1, 0, std::sin(a), 0, std::cos(a));
    const glm::dvec3 middle = 0.5 * (glm::dvec3(triangles.lo) + glm::dvec3(triangles.hi));
    for (scenes::Light& light : moment.lights) {
        light.position = glm::vec3(middle + turn * (glm::dvec3(light.position) - middle));
        light.direction = glm::vec3(glm::normalize(turn * glm::dvec3(light.direction)));
    }
    return moment;
}

BenchRow maps_row(const char* bench, const std::string& source, const char* technique, const passes::FrameSettings& settings) {
    BenchRow row;
    row.bench = bench;
    row.scene = std::filesystem::path(source).filename().string();
    row.technique = technique;
    row.views = settings.vpls;
    row.settings = {{"width", settings.width}, {"height", settings.height}};
    if (settings.visibility != Visibility::rays && settings.visibility != Visibility::none) row.settings["map_size"] = settings.maps.map_size;
    if (settings.visibility == Visibility::manylods || settings.visibility == Visibility::megaviews) {
        row.settings["epsilon"] = settings.maps.epsilon;
        if (settings.maps.coverage != coverage_exact) row.settings["coverage"] = choice_name(coverages(), settings.maps.coverage);
        if (settings.octree_levels) row.settings["levels"] = settings.octree_levels;
        else row.settings["samples"] = uint64_t(1) << settings.log2_samples, row.settings["arity"] = settings.maps.arity;
        if (settings.maps.update == CutUpdate::incremental) row.settings["revalidate"] = settings.maps.revalidate ? "all" : "due";
        if (settings.maps.update == CutUpdate::lazy) row.settings["q"] = settings.maps.lazy_edges;
    }
    if (settings.visibility == Visibility::ism) row.settings["points"] = settings.maps.ism.points;
    return row;
}

void add_maps_times(BenchRow& row, const passes::Frame& frame) {
    double total = 0;
    std::map<std::string, double> stages;
    for (const engine::PassTime& pass : frame.times())
        if (pass.name == "cut" || pass.name == "view tree" || pass.name == "pairs" || pass.name == "fuse" || pass.name == "splat" || pass.name == "brute" || pass.name == "ism") total += pass.gpu_ms, stages[pass.name] += pass.gpu_ms;
    row.ms.ms.push_back(total);
    for (const auto& [name, ms] : stages) row.stages[name].ms.push_back(ms);
}

double white_error(const std::vector<vec4>& reference, const std::vector<vec4>& test, uint32_t width, uint32_t height) {
    const auto image = [&](const std::vector<vec4>& values) {
        std::vector<float> texels;
        for (const vec4& v : values)
            for (int i = 0; i < 4; ++i) texels.push_back(v[i] / 3.14159265f);
        Image image;
        image.width = width, image.height = height;
        image.add({"R", "G", "B"}, texels, 4);
        return image;
    };
    return measure(image(reference), image(test), 0.01).rel_mse;
}

double indirect_light(const Image& image) {
    const Image::Rgb light = *image.rgb("indirect");
    double sum = 0;
    for (const std::span<const float> plane : {light.r, light.g, light.b}) sum = std::accumulate(plane.begin(), plane.end(), sum);
    return sum;
}

void require_folder(const std::string& images) {
    if (!images.empty() && !std::filesystem::is_directory(images)) throw InputError("--images '" + images + "': there is no such folder; create it");
}

void set_bytes(BenchRow& row, const engine::Device& device) {
    for (const auto& [kind, use] : device.memory()) row.bytes[kind == "lists" ? "pairs" : kind] = use.peak;
    row.bytes.try_emplace("pairs", 0);
    row.bytes.try_emplace("atlas", 0);
}

}  // namespace myriad::tools
