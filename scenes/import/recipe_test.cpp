// Recipes: what they make, and that each mistake is told with its place.
#include "scenes/import/recipe.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/refusal.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::vec3;
using glm::vec4;

class Recipes : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder = std::filesystem::temp_directory_path() / ("myriad_recipe_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder);
        // A block 1 x 2 x 4 whose corner is the origin, in centimetres, of two meshes and materials.
        put("block.ply", "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n"
                         "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 0 4\n1 0 4\n0 2 4\n1 2 4\n"
                         "4 0 4 6 2\n4 1 3 7 5\n4 0 1 5 4\n4 2 6 7 3\n4 0 2 3 1\n4 4 5 7 6\n");
        put("pair.obj", "mtllib pair.mtl\no cup\nusemtl white\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no saucer\nusemtl blue\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 4 5 6\n");
        put("pair.mtl", "newmtl white\nKd 1 1 1\nnewmtl blue\nKd 0 0 1\n");
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    std::string put(const std::string& name, const std::string& contents) {
        std::ofstream(folder / name, std::ios::binary) << contents;
        return (folder / name).string();
    }
    Scene make(const std::string& body) { return import_scene(put("r.json", "{\"recipe\": 1, " + body + "}")); }
    std::string refused(const std::string& text) {
        const std::string path = put("r.json", text);
        return refusal(path, [&] { import_scene(path); });
    }
    void refuse(const std::string& body, const std::string& part) {
        const std::string message = refused("{\"recipe\": 1, " + body + "}");
        EXPECT_NE(message.find(part), std::string::npos) << message << "\n  lacks: " << part;
    }

    std::filesystem::path folder;
};

std::pair<vec3, vec3> bounds(Scene scene) {
    const Triangles t = flatten(scene);
    return {t.lo, t.hi};
}

void expect_bounds(const Scene& scene, const vec3& lo, const vec3& hi, float tolerance = 1e-5f) {
    const auto [a, b] = bounds(scene);
    EXPECT_LE(glm::length(a - lo), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << lo.x << " " << lo.y << " " << lo.z;
    EXPECT_LE(glm::length(b - hi), tolerance) << b.x << " " << b.y << " " << b.z << " is not " << hi.x << " " << hi.y << " " << hi.z;
}

TEST_F(Recipes, PlacesAPart) {
    expect_bounds(make(R"("parts": [{"file": "block.ply"}])"), {0, 0, 0}, {1, 2, 4});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "unit": 0.01, "scale": 100, "at": [1, 2, 3]}])"), {1, 2, 3}, {2, 4, 7});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "anchor": "bottom"}])"), {-0.5f, 0, -2}, {0.5f, 2, 2});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "anchor": "middle", "at": [0, 5, 0]}])"), {-0.5f, 4, -2}, {0.5f, 6, 2});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "anchor": "bottom", "turn": 90}])"), {-2, 0, -0.5f}, {2, 2, 0.5f});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "up": "z"}])"), {0, 0, -2}, {1, 4, 0});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "rotate": [-90, 0, 0]}])"), {0, 0, -2}, {1, 4, 0});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "rotate": [-90, 90, 0]}])"), {-2, 0, -1}, {0, 4, 0});  // x first, then y
}

TEST_F(Recipes, FitsAPart) {
    expect_bounds(make(R"("parts": [{"file": "block.ply", "fit": {"width": 0.5}}])"), {0, 0, 0}, {0.5f, 1, 2});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "fit": {"height": 1}}])"), {0, 0, 0}, {0.5f, 1, 2});
    expect_bounds(make(R"("parts": [{"file": "block.ply", "fit": {"longest": 8}, "rotate": [-90, 0, 0], "anchor": "bottom"}])"), {-1, 0, -2}, {1, 8, 2});
}

TEST_F(Recipes, StacksAndShares) {
    const Scene scene = make(R"("parts": [{"name": "table", "file": "block.ply", "anchor": "bottom", "at": [0, 1, 0]},
        {"file": "block.ply", "anchor": "bottom", "on": "table", "places": [{"at": [0, 0.5, 0]}, {"at": [10, 0, 0], "turn": 90, "scale": 2}]}])");
    EXPECT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.instances.size(), 3u);
    expect_bounds(scene, {-0.5f, 1, -2}, {14, 7, 2});
}

TEST_F(Recipes, ChoosesMeshesAndMaterials) {
    EXPECT_EQ(make(R"("parts": [{"file": "pair.obj"}])").meshes.size(), 2u);
    EXPECT_EQ(make(R"("parts": [{"file": "pair.obj", "only": ["c*"]}])").meshes[0].name, "cup");
    EXPECT_EQ(make(R"("parts": [{"file": "pair.obj", "without": ["*u*p"]}])").meshes[0].name, "saucer");
    const Scene scene = make(R"("materials": {"gold": {"base_color": [1, 0.8, 0.2], "metallic": 1}},
        "parts": [{"file": "pair.obj", "materials": {"white": "gold", "bl*": {"base_color": [0, 1, 0], "roughness": 0.25}}}])");
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[0].name, "gold");
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_EQ(scene.materials[1].name, "blue");
    EXPECT_EQ(scene.materials[1].base_color, vec4(0, 1, 0, 1));
    EXPECT_EQ(scene.materials[1].roughness, 0.25f);
    EXPECT_TRUE(scene.materials[1].double_sided);  // as it was
}

TEST_F(Recipes, Textures) {
    std::string tga(18, '\0');
    tga[2] = 2, tga[12] = 1, tga[14] = 1, tga[16] = 24;
    put("red.tga", tga + std::string("\0\0\xff", 3));
    const Scene scene = make(R"("materials": {"red": {"texture": "red.tga"}}, "boxes": [{"size": [1, 1, 1], "material": "red"}],
        "parts": [{"file": "pair.obj", "materials": {"white": {"texture": "red.tga"}}}])");
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].rgba, (std::vector<uint8_t>{255, 0, 0, 255}));
    EXPECT_EQ(std::ranges::count_if(scene.materials, [](const Material& m) { return m.base_color_texture.texture == 0; }), 2);
}

TEST_F(Recipes, RoomsAreSeenFromInside) {
    Scene scene = make(R"("room": {"size": [4, 3, 2], "at": [1, 0, 0], "open": ["front"]})");
    const Triangles t = flatten(scene);
    ASSERT_EQ(t.triangles.size(), 10u);
    for (const auto& c : t.triangles) {
        const vec3 a = t.positions[c.x], n = glm::cross(t.positions[c.y] - a, t.positions[c.z] - a);
        EXPECT_GT(glm::dot(n, vec3(1, 1.5f, 0) - a), 0);
        EXPECT_GT(glm::dot(n, t.normals[c.x]), 0);
        EXPECT_FALSE(n.z < 0 && n.x == 0 && n.y == 0);  // the open side
    }
    expect_bounds(scene, {-1, 0, -1}, {3, 3, 1});
}

TEST_F(Recipes, PanelsAndLights) {
    Scene scene = make(R"("panels": [{"at": [0, 3, 0], "size": [2, 1], "radiance": [5, 6, 7]}, {"at": [5, 0, 0], "size": [2, 2], "toward": [0, 0, 0]}],
        "lights": [{"type": "sun", "at": [0, 10, 0], "toward": [0, 0, 0], "intensity": [3, 2, 1], "name": "sun"},
                   {"type": "spot", "at": [1, 2, 3], "inner": 10, "outer": 20}, {"type": "point", "at": [1, 1, 1]}])");
    const Triangles t = flatten(scene);
    EXPECT_LE(glm::length(t.normals[t.triangles[0].x] - vec3(0, -1, 0)), 1e-5f);
    EXPECT_LE(glm::length(t.normals[t.triangles[2].x] - vec3(-1, 0, 0)), 1e-5f);
    EXPECT_EQ(scene.materials[t.triangles[0].w].emissive, vec3(5, 6, 7));
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].type, Light::Type::directional);
    EXPECT_EQ(scene.lights[0].direction, vec3(0, -1, 0));
    EXPECT_NEAR(scene.lights[1].outer_cone, 0.34906585f, 1e-6f);
    EXPECT_EQ(scene.lights[2].type, Light::Type::point);
}

TEST_F(Recipes, Cameras) {
    const Scene scene = make(R"("background": [1, 2, 3], "boxes": [{"name": "crate", "size": [2, 2, 2], "at": [0, -1, 0]}], "room": {"size": [90, 90, 90]},
        "cameras": [{"name": "a", "eye": [0, 0, 5], "target": [0, 0, 0], "yfov": 60}, {"name": "b", "frame": "all", "from": [0, 1, 0]}])");
    EXPECT_EQ(scene.background, vec3(1, 2, 3));
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_NEAR(scene.cameras[0].yfov, 1.0471976f, 1e-6f);
    EXPECT_LE(glm::length(vec3(scene.cameras[0].to_world[2]) - vec3(0, 0, 1)), 1e-6f);
    const vec3 eye = scene.cameras[1].to_world[3];  // straight above, where the crate's sphere just fits; the room does not count
    EXPECT_LE(glm::length(eye - vec3(0, 1.05f * std::sqrt(3.0f) / std::sin(glm::radians(22.5f)), 0)), 1e-4f);
    EXPECT_LE(glm::length(vec3(scene.cameras[1].to_world[2]) - vec3(0, 1, 0)), 1e-6f);
}

TEST_F(Recipes, ABuiltInIsAPartToo) {
    EXPECT_EQ(make(R"("parts": [{"file": "builtin:cornell"}])").cameras.size(), 0u);
    EXPECT_EQ(make(R"("parts": [{"file": "builtin:cornell", "cameras": true, "at": [1, 0, 0]}])").cameras.size(), 1u);
}

// The same scene of some kilobytes twice: a recipe of a few lines must not take all the memory there is.
TEST_F(Recipes, PartsAreBounded) {
    const std::string path = put("r.json", R"({"recipe": 1, "parts": [{"file": "builtin:cornell?cells=1"}, {"name": "again", "file": "builtin:cornell?cells=1"}]})");
    EXPECT_EQ(importing::read_recipe(path).meshes.size() % 2, 0u);
    try {
        importing::read_recipe(path, 10 << 10);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("parts[1] \"again\": the parts up to it take too much memory"), std::string::npos) << e.what();
    }
}

TEST_F(Recipes, TheExampleOfThePageIsRight) {
    for (const char* name : {"table.obj", "teapot.obj", "cup.obj"}) put(name, "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    std::ifstream page(MYRIAD_RECIPES);
    ASSERT_TRUE(page);
    const std::string text(std::istreambuf_iterator<char>(page), {});
    const size_t begin = text.find("```json\n") + 8;
    const Scene scene = import_scene(put("r.json", text.substr(begin, text.find("```", begin) - begin)));
    EXPECT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.instances.size(), 6u);
}

TEST_F(Recipes, MistakesAreTold) {
    EXPECT_NE(refused("{").find("line 1, column 2"), std::string::npos);
    EXPECT_NE(refused("{\"recipe\": 1e999}").find("number overflow"), std::string::npos);
    EXPECT_NE(refused("[]").find("not an object"), std::string::npos);
    EXPECT_NE(refused("{}").find("version 1"), std::string::npos);
    EXPECT_NE(refused("{\"recipe\": 2}").find("version 1"), std::string::npos);
    refused(std::string(100000, '['));
    refuse(R"("part": [])", "\"part\" is unknown; known are recipe, ");
    refuse(R"("parts": {})", "parts is no list");
    refuse(R"("parts": [{}])", "parts[0]: there is no file");
    refuse(R"("parts": [{"file": "none.obj"}])", "there is no file \"none.obj\"");
    refuse(R"("parts": [{"file": "../x.obj"}])", "outside of the recipe's folder");
    refuse(R"("parts": [{"file": "/etc/passwd"}])", "outside of the recipe's folder");
    refuse(R"("parts": [{"file": "r.json"}])", "a recipe itself");
    refuse(R"("parts": [{"file": "pair.mtl"}])", "parts[0]: ");
    refuse(R"("parts": [{"file": "pair.obj", "only": ["none"]}])", "nothing of it is left");
    refuse(R"("parts": [{"name": "x", "file": "pair.obj", "materials": {"red": {}}}])", "parts[0] \"x\" materials \"red\": no material has such a name; known are \"white\", \"blue\"");
    refuse(R"("parts": [{"file": "pair.obj", "materials": {"white": "gold"}}])", "there is no material \"gold\"");
    refuse(R"("parts": [{"file": "pair.obj", "fit": {}}])", "it has no length");
    refuse(R"("parts": [{"file": "pair.obj", "fit": {"width": 1, "height": 1}}])", "more than one length");
    refuse(R"("parts": [{"file": "pair.obj", "only": ["cup"], "fit": {"depth": 1}}])", "no depth");
    refuse(R"("parts": [{"file": "pair.obj", "on": "table"}])", "no part \"table\"");
    refuse(R"("parts": [{"file": "pair.obj", "at": [1, 2]}])", "at is not 3 numbers");
    refuse(R"("parts": [{"file": "pair.obj", "at": [1, 2, 1e99]}])", "at is not 3 numbers");
    refuse(R"("parts": [{"file": "pair.obj", "turn": "90"}])", "turn is no number");
    refuse(R"("parts": [{"file": "pair.obj", "places": [{"to": 1}]}])", "places[0]: \"to\" is unknown");
    refuse(R"("parts": [{"file": "pair.obj", "at": [0, 0, 0], "places": []}])", "besides");
    refuse(R"("parts": [{"file": "pair.obj", "anchor": "top"}])", "origin, bottom, middle");
    refuse(R"("materials": {"a": {"base_color": [2, 0, 0]}})", "materials \"a\": base_color");
    refuse(R"("materials": {"a": {"texture": "none.png"}})", "none.png");
    refuse(R"("materials": {"a": {"texture": "pair.obj"}})", "cannot be decoded");
    refuse(R"("room": {})", "there is no size");
    refuse(R"("room": {"size": [1, 1, 1], "open": ["top"]})", "no side \"top\"");
    refuse(R"("room": {"size": [1, 1, 1], "walls": "gold"})", "no material \"gold\"");
    refuse(R"("boxes": [{"size": [0, 1, 1]}])", "boxes[0]: size");
    refuse(R"("panels": [{"size": [1, 1], "toward": [0, 0, 0]}])", "where the panel is");
    refuse(R"("lights": [{}])", "point, spot or sun");
    refuse(R"("lights": [{"type": "spot", "inner": 60}])", "wider");
    refuse(R"("cameras": [{"eye": [0, 0, 0]}])", "give both");
    refuse(R"("cameras": [{"eye": [0, 0, 0], "target": [0, 0, 0]}])", "target is where it stands");
    refuse(R"("cameras": [{"frame": "all"}])", "nothing to frame");
    refuse(R"("cameras": [{"frame": "x"}])", "no part \"x\" to frame");
}

}  // namespace
}  // namespace myriad::scenes::importing
