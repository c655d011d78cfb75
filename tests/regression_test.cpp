// Small images that must not change unless someone says so: scene file or built-in, whole frame, against goldens/*.exr, judged by what
// `myriad compare --golden` runs. The images stay in the build folder, tests/regression, with a heat map and the numbers of each that
// fails. After a change that is meant to be seen, look at them, then
//     build/bin/myriad compare --golden tests/goldens build/tests/regression --bless "why they change"
// or, of some of the tests only,
//     MYRIAD_BLESS="why they change" build/bin/myriad_frame_tests --gtest_filter='Regression.*'
// writes the goldens anew and says in goldens/blessed.log how far each moved; both are part of the change and are reviewed with it.
#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "scenes/gltf/write.hpp"
#include "tests/materials_scene.hpp"
#include "tools/commands.hpp"
#include "tools/exr.hpp"
#include "tools/goldens.hpp"
#include "tools/output_file.hpp"
#include "tools/render_image.hpp"
#include "tools/revision.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::tests {
namespace {

using nlohmann::json;
using passes::Visibility;
using tools::GoldenResult, tools::Image, tools::TempFolder, tools::contains;
using Path = std::filesystem::path;

// Images are compared as goldens are stored, in halves, so on one driver nothing may differ at all; nor did anything between Mesa
// 22.3.6 and 25.0.7 when this was written. Devices may round 1/sqrt, pow and contracted sums in other ways: pixels on edges then see
// another triangle, a few look-ups another texel. The limits leave room for that, and are a tenth of what 3 % of brightness or a wrong
// 8 x 8 tile make (the negative tests below).
constexpr const char* limits[] = {"relMSE=5e-5", "failing=0.004"};  // failing: share of pixels off by more than
constexpr const char* tolerance = "2%";                              // of the mean of the golden

// Images are written here, heat maps into a folder below.
tools::GoldenOptions options(const Path& out) {
    tools::GoldenOptions o{.comparison = {}, .heat_maps = out / "heat_maps"};
    o.comparison.tolerance = tools::parse_tolerance("tolerance", tolerance);
    for (const char* limit : limits) o.comparison.limits.push_back(tools::parse_limit(limit, true));
    return o;
}

double mean(const Image& image) {
    double sum = 0;
    const Image::Rgb c = *image.rgb();
    for (const auto& plane : {c.r, c.g, c.b})
        for (float v : plane) sum += v;
    return sum / (3 * double(image.pixels()));
}

// Through a file, in halves, as goldens are. Leaves the numbers in `out` when it fails.
GoldenResult judge(const Path& golden, const Image& image, const Path& out) {
    std::filesystem::create_directories(out);
    const Path name = golden.filename(), numbers = out / (golden.stem().string() + ".json");
    tools::write_exr(out / name, image);
    const GoldenResult result = tools::judge_golden(golden, out / name, name, options(out));
    std::filesystem::remove(numbers);
    if (result.heat_map.empty()) std::filesystem::remove(out / "heat_maps" / name.stem().replace_extension(".png"));
    if (!result.passed()) tools::write_text(numbers, tools::golden_json({result}, options(out).comparison.limits).dump(2) + "\n");
    return result;
}

std::string failure(const GoldenResult& result, const Path& out) {
    std::string text;
    for (const std::string& f : result.failures) text += f + "; ";
    if (text.empty()) return text;
    const std::string program = std::filesystem::read_symlink("/proc/self/exe");
    return text + "see " + out.string() + ", and if it is right: MYRIAD_BLESS=\"why\" " + program + " --gtest_filter='Regression.*'";
}

// A court with two boxes, one of them turned and half sunk, a lamp and a point light: transforms, shared meshes, indices, emission
// and its strength, lights and a camera, as a file.
void write_court(const Path& path) {
    std::string bin;
    json doc = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_emissive_strength"}}};
    const auto accessor = [&](const auto& values, int component, const char* type, size_t count, const json& more) {
        const size_t bytes = values.size() * sizeof(values[0]);
        doc["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}});
        bin.append(reinterpret_cast<const char*>(values.data()), bytes);
        json a = {{"bufferView", doc["bufferViews"].size() - 1}, {"componentType", component}, {"type", type}, {"count", count}};
        a.update(more);
        doc["accessors"].push_back(a);
        return doc["accessors"].size() - 1;
    };
    // The cube [-1, 1]^3, eight vertices.
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) corners.push_back(i >> axis & 1 ? 1.0f : -1.0f);
    std::vector<uint32_t> out = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6}, in(out.rbegin(), out.rend());
    const auto position = accessor(corners, 5126, "VEC3", 8, {{"min", {-1, -1, -1}}, {"max", {1, 1, 1}}});
    const auto outside = accessor(out, 5125, "SCALAR", 36, json::object()), inside = accessor(in, 5125, "SCALAR", 36, json::object());
    const auto material = [&](json color, json more) {
        json m = {{"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 0}}}};
        m.update(more);
        doc["materials"].push_back(m);
    };
    material({0.7, 0.7, 0.65, 1}, json::object());
    material({0.2, 0.3, 0.7, 1}, json::object());
    material({0, 0, 0, 1}, {{"emissiveFactor", {1, 0.8, 0.5}}, {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 12}}}}}});
    for (const auto& [indices, m] : {std::pair{inside, 0}, {outside, 1}, {outside, 2}})
        doc["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", indices}, {"material", m}}}}});
    doc["nodes"] = {{{"mesh", 0}, {"scale", {3, 2, 3}}},
                    {{"mesh", 1}, {"translation", {-1, -1.2, -1}}, {"scale", {0.6, 0.8, 0.6}}, {"rotation", {0, 0.2588190, 0, 0.9659258}}},
                    {{"mesh", 1}, {"translation", {1.1, -1.8, 0.2}}, {"scale", {0.7, 0.7, 0.7}}, {"rotation", {0.3, 0.2, 0.1, 0.9273618}}},
                    {{"mesh", 2}, {"translation", {0, 1.95, -1}}, {"scale", {0.5, 0.02, 0.5}}},
                    {{"camera", 0}, {"translation", {0, 0.2, 2.8}}},
                    {{"translation", {2, 1, 1.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    doc["scenes"] = {{{"nodes", {0, 1, 2, 3, 4, 5}}}};
    doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.01}}}}};
    doc["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"color", {0.4, 0.7, 1}}, {"intensity", 6}}}}}}};
    doc["buffers"] = {{{"byteLength", bin.size()}}};

    std::string text = doc.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file;
    const auto word = [&](uint32_t v) { file.append(reinterpret_cast<const char*>(&v), 4); };
    word(0x46546c67), word(2), word(uint32_t(28 + text.size() + bin.size()));
    word(uint32_t(text.size())), word(0x4e4f534a), file += text;
    word(uint32_t(bin.size())), word(0x004e4942), file += bin;
    tools::put(path, file);
}

class Regression : public engine::DeviceTest {
protected:
    Image render(const std::string& source, Visibility visibility) { return render(scenes::load(source), visibility); }
    Image render(scenes::Scene scene, Visibility visibility) {
        const scenes::Triangles triangles = scenes::flatten(scene);
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
        passes::FrameSettings s;
        s.width = 96, s.height = 64;
        s.vpls = 256, s.subset = 64, s.bounces = 2;
        s.log2_samples = 15;
        s.maps.map_size = 32;
        s.visibility = visibility;
        passes::Frame frame(device, scene, triangles, s);
        frame.render(scenes::pick_camera(scene, triangles, ""));
        Image image = tools::read_image(device, frame, {});
        image.metadata = {{"scene", std::filesystem::path(scene.name).filename()}, {"device", device.info().name},
                          {"driver", device.info().driver + " " + device.info().driver_version}};
        return image;
    }

    void check(const std::string& name, const std::string& source, Visibility visibility) { check(name, scenes::load(source), visibility); }
    void check(const std::string& name, const scenes::Scene& scene, Visibility visibility) {
        const Image image = render(scene, visibility);
        const Path golden = Path(MYRIAD_GOLDENS) / (name + ".exr"), out = MYRIAD_REGRESSION_OUT;
        const GoldenResult result = judge(golden, image, out);
        if (const char* reason = std::getenv("MYRIAD_BLESS")) {
            ASSERT_STRNE(reason, "1") << "say why the images change: MYRIAD_BLESS=\"softer shadows\"";
            const std::string by = std::string("myriad ") + tools::git_revision + " on " + image.metadata.at("driver");
            const bool moved = !tools::bless(MYRIAD_GOLDENS, out, {name + ".exr"}, options(out).comparison, {reason, by}).empty();
            EXPECT_LT(std::filesystem::file_size(golden), 60000u);
            GTEST_SKIP() << (moved ? "blessed " : "left as it was ") << golden << ", not compared";
        }
        EXPECT_EQ(failure(result, out), "");
        if (!result.metrics) return;
        RecordProperty("relMSE", std::to_string(result.metrics->rel_mse));
        const tools::Metrics& m = *result.metrics;
        std::printf("%s: relMSE %.2g, failing %.4f, FLIP %.4f\n", name.c_str(), m.rel_mse, m.failing, m.flip);
    }
};

TEST_F(Regression, cornell_manylods) { check("cornell_manylods", "builtin:cornell", Visibility::manylods); }
TEST_F(Regression, cornell_rays) { check("cornell_rays", "builtin:cornell", Visibility::rays); }
TEST_F(Regression, atrium_manylods) { check("atrium_manylods", "builtin:atrium?detail=0.25", Visibility::manylods); }
TEST_F(Regression, gltf_manylods) {
    const TempFolder folder;
    write_court(folder / "court.glb");
    check("court_manylods", folder / "court.glb", Visibility::manylods);
}

TEST_F(Regression, materials_manylods) { check("materials_manylods", MaterialsScene::make(), Visibility::manylods); }
TEST_F(Regression, materials_rays) { check("materials_rays", MaterialsScene::make(), Visibility::rays); }

// Through a file: what the writer and the loader say of materials arrives on the device.
TEST_F(Regression, materials_of_a_file) {
    const scenes::Scene made = MaterialsScene::make();
    const TempFolder folder;
    tools::put(folder / "materials.glb", scenes::glb_bytes(made));
    scenes::Scene read = scenes::load(folder / "materials.glb");
    // glTF has no background, and rounds directions, which sends other paths.
    read.background = made.background, read.lights = made.lights, read.cameras = made.cameras;
    EXPECT_EQ(tools::measure(render(made, Visibility::rays), render(read, Visibility::rays), 0).max_abs, 0);
}

// With cut-outs and panes, maps are as near to rays as elsewhere.
TEST_F(Regression, maps_know_the_holes) {
    const scenes::Scene scene = MaterialsScene::make();
    const double error = tools::measure(render(scene, Visibility::rays), render(scene, Visibility::manylods), 0).rel_mse;
    std::printf("maps against rays: relMSE %.3g\n", error);
    EXPECT_LT(error, 1e-3);
}

// ---- The judge itself, and the command that is one with it ----

class Judge : public ::testing::Test {
protected:
    Judge() {
        image.width = 96, image.height = 64;
        for (const char* name : {"R", "G", "B"}) {
            std::vector<float>& plane = image.add(name);
            for (size_t i = 0; i < plane.size(); ++i) plane[i] = 0.2f + 0.1f * std::sin(float(i % 96) / 7) * std::cos(float(i / 96) / 5);
        }
        std::filesystem::create_directory(folder / "goldens");
        tools::write_exr(golden, image);
    }
    GoldenResult result(const Image& test) { return judge(golden, test, folder / "out"); }
    std::string failure(const Image& test) { return tests::failure(result(test), folder / "out"); }
    bool left(const char* name) { return std::filesystem::exists(folder / "out" / name); }

    // The exit status of `myriad compare` with the same limits, of the image that was judged last.
    int command() {
        CLI::App app;
        tools::add_compare(app);
        std::vector<std::string> arguments = {"compare", "--golden", folder / "goldens", folder / "out", "--tolerance", tolerance};
        for (const char* limit : limits) arguments.insert(arguments.end(), {"--fail-above", limit});
        std::ranges::reverse(arguments);  // CLI11 takes them from the back
        try {
            app.parse(arguments);
        } catch (const Error& e) {
            return e.exit_status();
        }
        return 0;
    }

    const TempFolder folder;
    const Path golden = folder / "goldens" / "g.exr";
    Image image;
};

TEST_F(Judge, passes_the_same_image_through_halves) {
    EXPECT_EQ(failure(image), "");
    EXPECT_NEAR(result(image).metrics->tolerance, 0.02 * mean(image), 1e-5);
    EXPECT_FALSE(left("g.json") || left("heat_maps"));
    EXPECT_EQ(command(), 0);
}

TEST_F(Judge, fails_perturbed_images_and_shows_them) {
    Image brighter = image, tile = image, nan = image;
    for (auto& channel : brighter.channels)
        for (float& v : channel.values) v *= 1.03f;
    for (size_t i = 0; i < 64; ++i) tile.channels[1].values[(20 + i / 8) * 96 + 30 + i % 8] += 0.01f;
    nan.channels[2].values[5] = std::nanf("");
    for (const Image& test : {brighter, tile, nan}) {
        EXPECT_TRUE(contains(failure(test), "MYRIAD_BLESS"));
        EXPECT_TRUE(left("g.exr") && left("heat_maps/g.png"));
        EXPECT_EQ(command(), 1);
        std::filesystem::remove_all(folder / "out" / "heat_maps");
    }
    std::ifstream in(folder / "out" / "g.json");
    const json numbers = json::parse(in);
    EXPECT_EQ(numbers["limits"][0], "relMSE <= 5e-05");
    EXPECT_EQ(numbers["images"][0]["kind"], "nonfinite");
}

TEST_F(Judge, fails_a_missing_golden_with_the_cure) {
    std::filesystem::remove(golden);
    const std::string text = failure(image);
    EXPECT_TRUE(contains(text, "MYRIAD_BLESS") && contains(text, "no golden")) << text;
    EXPECT_TRUE(left("g.exr"));
    EXPECT_NE(command(), 0);
}

TEST_F(Judge, fails_another_size) {
    Image small;
    small.width = small.height = 8;
    for (const char* name : {"R", "G", "B"}) small.add(name);
    EXPECT_TRUE(contains(failure(small), "8x8 and its golden 96x64"));
    EXPECT_EQ(command(), 1);
}

}  // namespace
}  // namespace myriad::tests
