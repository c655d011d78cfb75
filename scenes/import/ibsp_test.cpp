// Small maps written by the test: what is read and what is left out, and that every lie in a file is one sentence.
#include "scenes/import/ibsp.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "engine/error.hpp"
#include "scenes/import/ibsp_look.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::vec3;

// A map under construction. Records are 32-bit words, as nearly all of the format is.
struct Map {
    using Words = std::vector<uint32_t>;
    std::string entities;
    Words shaders, models, vertices, meshverts, faces;

    static uint32_t bits(float f) {
        uint32_t u;
        std::memcpy(&u, &f, 4);
        return u;
    }
    uint32_t shader(const std::string& name, uint32_t flags = 0, uint32_t contents = 1) {
        Words words(18);
        std::memcpy(words.data(), name.data(), std::min<size_t>(name.size(), 64));
        words[16] = flags, words[17] = contents;
        shaders.insert(shaders.end(), words.begin(), words.end());
        return uint32_t(shaders.size() / 18 - 1);
    }
    uint32_t vertex(const vec3& at, const vec3& normal = {0, 0, 1}) {
        for (float f : {at.x, at.y, at.z, 0.5f, 0.25f, 0.0f, 0.0f, normal.x, normal.y, normal.z}) vertices.push_back(bits(f));
        vertices.push_back(~0u);
        return uint32_t(vertices.size() / 11 - 1);
    }
    Words& face(uint32_t shader, uint32_t type, uint32_t first, uint32_t count, uint32_t meshvert = 0, uint32_t corners = 0, uint32_t w = 0, uint32_t h = 0) {
        Words words(26);
        words[0] = shader, words[2] = type, words[3] = first, words[4] = count, words[5] = meshvert, words[6] = corners;
        words[24] = w, words[25] = h;
        faces.insert(faces.end(), words.begin(), words.end());
        return faces;
    }
    void model(uint32_t first, uint32_t count) {
        for (uint32_t w : {0u, 0u, 0u, 0u, 0u, 0u, first, count, 0u, 0u}) models.push_back(w);
    }
    // 64 x 32 units on the ground, seen from above: clockwise, as the games have it.
    void square(uint32_t shader, float z = 0) {
        const uint32_t first = vertex({0, 0, z});
        vertex({0, 32, z}), vertex({64, 32, z}), vertex({64, 0, z});
        const uint32_t corner = uint32_t(meshverts.size());
        meshverts.insert(meshverts.end(), {0, 1, 2, 0, 2, 3});
        face(shader, 1, first, 4, corner, 6);
    }
    static Map ground() {
        Map map;
        map.square(map.shader("textures/base_floor/tile"));
        map.model(0, 1);
        return map;
    }

    Bytes bytes() const {
        Bytes out(8 + 17 * 8);
        const auto word = [&](size_t at, uint32_t value) { std::memcpy(&out[at], &value, 4); };
        word(0, 0x50534249), word(4, 46);
        const auto lump = [&](size_t number, const void* data, size_t size) {
            word(8 + 8 * number, uint32_t(out.size())), word(12 + 8 * number, uint32_t(size));
            const auto* from = static_cast<const uint8_t*>(data);
            out.insert(out.end(), from, from + size);
        };
        lump(0, entities.data(), entities.size());
        lump(1, shaders.data(), 4 * shaders.size());
        lump(7, models.data(), 4 * models.size());
        lump(10, vertices.data(), 4 * vertices.size());
        lump(11, meshverts.data(), 4 * meshverts.size());
        lump(13, faces.data(), 4 * faces.size());
        return out;
    }
    Scene read(const IbspOptions& options = {}) const {
        const Bytes file = bytes();
        return read_ibsp(View(file, "test.bsp"), options);
    }
};

std::string refusal(const Bytes& bytes) {
    try {
        read_ibsp(View(bytes, "test.bsp"));
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}
std::string refusal(const Map& map) { return refusal(map.bytes()); }

void expect_near(const vec3& a, const vec3& b, float tolerance = 1e-5f) { EXPECT_LT(glm::distance(a, b), tolerance) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(Ibsp, a_square_faces_up) {
    Scene scene = Map::ground().read();
    const Triangles t = flatten(scene);
    ASSERT_EQ(t.triangles.size(), 2u);
    expect_near(t.lo, {0, 0, 0});
    expect_near(t.hi, {64, 32, 0});
    for (const auto& c : t.triangles) {
        const vec3 front = glm::cross(t.positions[c.y] - t.positions[c.x], t.positions[c.z] - t.positions[c.x]);
        EXPECT_GT(front.z, 0);
        expect_near(t.normals[c.x], {0, 0, 1});
    }
    EXPECT_EQ(t.texcoords[0], glm::vec2(0.5f, 0.25f));
    EXPECT_EQ(scene.materials.at(0).name, "textures/base_floor/tile");
    EXPECT_TRUE(scene.warnings.empty());
}

// As `myriad convert` sees it: metres, +Y up; the light falls off in metres too.
TEST(Ibsp, is_imported_in_metres) {
    Map map = Map::ground();
    map.entities = "{ \"classname\" \"light\" \"origin\" \"32 64 96\" \"light\" \"255\" }";
    const auto path = std::filesystem::temp_directory_path() / ("myriad_ibsp_" + std::to_string(::getpid()) + ".bsp");
    const Bytes bytes = map.bytes();
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    for (double unit : {1.0 / 32, 1.0}) {
        Scene scene = import_scene(path.string(), unit == 1 ? ImportOptions{.unit = 1} : ImportOptions{});
        const Triangles t = flatten(scene);
        expect_near(t.lo, vec3(0, 0, -32) * float(unit));
        expect_near(t.hi, vec3(64, 0, 0) * float(unit));
        expect_near(t.normals.at(0), {0, 1, 0});
        expect_near(scene.lights.at(0).position, vec3(32, 96, -64) * float(unit));
        EXPECT_NEAR(scene.lights[0].intensity.x / (3.14159265f * 7500 * float(unit * unit)), 1, 1e-5f);
    }
    std::filesystem::remove(path);
}

TEST(Ibsp, leaves_out_what_players_do_not_see) {
    Map map = Map::ground();
    map.square(map.shader("textures/skies/sky", 0x4));
    map.square(map.shader("textures/common/clip", 0x80));
    map.square(map.shader("textures/common/hint", 0x100));
    map.square(map.shader("textures/common/skip", 0x200));
    map.square(map.shader("textures/sfx/fog", 0, 0x40));
    map.face(0, 4, 0, 1);   // a flare
    map.face(0, 77, 0, 1);  // whatever that is
    map.models.clear();
    map.model(0, 8);
    Scene scene = map.read();
    EXPECT_EQ(flatten(scene).triangles.size(), 2u);
    EXPECT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.background, sky_radiance);
    EXPECT_EQ(Map::ground().read().background, vec3(0));
}

// A quarter of a cylinder about z, which no polynomial is: the control points of the parabola that the format has in its place.
Map arch(float size = 64) {
    Map map;
    map.shader("textures/stone");
    for (float z : {0.0f, 16.0f, 32.0f})
        for (const glm::vec2& p : {glm::vec2(size, 0), glm::vec2(size, size), glm::vec2(0, size)}) map.vertex({p.x, p.y, z});
    map.face(0, 2, 0, 9, 0, 0, 3, 3);
    map.model(0, 1);
    return map;
}

TEST(Ibsp, patches_stay_within_the_tolerance) {
    size_t last = 0;
    for (float tolerance : {3.0f, 0.3f, 0.03f}) {
        Scene scene = arch().read({.tolerance = tolerance});
        const Triangles t = flatten(scene);
        EXPECT_GT(t.triangles.size(), last);
        last = t.triangles.size();
        // The curve is (1 - t^2, 2t - t^2) * 64. Midpoints of edges along it are the worst places.
        float worst = 0;
        for (const auto& c : t.triangles)
            for (int k = 0; k < 3; ++k) {
                const vec3 mid = 0.5f * (t.positions[c[k]] + t.positions[c[(k + 1) % 3]]);
                float nearest = 1e9f;
                for (int i = 0; i <= 40000; ++i) {
                    const float s = float(i) / 40000;
                    nearest = std::min(nearest, std::hypot(mid.x - 64 * (1 - s * s), mid.y - 64 * (2 * s - s * s)));
                }
                worst = std::max(worst, nearest);
            }
        EXPECT_LE(worst, tolerance);
        EXPECT_GT(worst, tolerance / 8) << "far more triangles than asked for";
    }
}

TEST(Ibsp, patches_have_smooth_normals_that_agree_with_their_fronts) {
    Scene scene = arch().read();
    const Triangles t = flatten(scene);
    for (const auto& c : t.triangles) {
        const vec3 front = glm::normalize(glm::cross(t.positions[c.y] - t.positions[c.x], t.positions[c.z] - t.positions[c.x]));
        for (int k = 0; k < 3; ++k) EXPECT_GT(glm::dot(front, t.normals[c[k]]), 0.95f);
    }
}

TEST(Ibsp, patches_of_several_share_their_borders) {
    Map map;
    map.shader("textures/stone");
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x) map.vertex({float(x) * 16, float(y) * 16, float((x * 7 + y * 5) % 4) * 9});
    map.face(0, 2, 0, 35, 0, 0, 7, 5);
    map.model(0, 1);
    Scene scene = map.read();
    const Triangles t = flatten(scene);
    // Each inner edge has two triangles, and each outer one lies on the rim.
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const auto& c : t.triangles)
        for (int k = 0; k < 3; ++k) ++edges[std::minmax(c[k], c[(k + 1) % 3])];
    for (const auto& [edge, count] : edges) {
        const vec3 a = t.positions[edge.first], b = t.positions[edge.second];
        const bool rim = (a.x < 1e-3f && b.x < 1e-3f) || (a.x > 95.999f && b.x > 95.999f) || (a.y < 1e-3f && b.y < 1e-3f) ||
                         (a.y > 63.999f && b.y > 63.999f);
        EXPECT_EQ(count, rim ? 1 : 2);
    }
}

TEST(Ibsp, doors_stand_where_their_entity_says) {
    Map map = Map::ground();
    map.square(0, 32);
    map.model(1, 1);
    map.model(0, 0);
    map.entities = "{ \"classname\" \"func_door\" \"model\" \"*1\" \"origin\" \"32 0 64\" } { \"model\" \"*2\" } { \"model\" \"models/x.md3\" }";
    Scene scene = map.read();
    ASSERT_EQ(scene.instances.size(), 2u);  // the empty model makes none
    const Triangles t = flatten(scene);
    expect_near(t.hi, {96, 32, 96});
}

TEST(Ibsp, lights_shine_as_the_light_tool_had_it) {
    Map map = Map::ground();
    map.entities = "{ \"classname\" \"light\" \"origin\" \"32 64 96\" \"light\" \"255\" \"_color\" \"0.5 0.25 0\" }\n"
                   "{ \"classname\" \"light\" \"origin\" \"0 0 128\" \"target\" \"spot\" }\n"
                   "{ \"classname\" \"info_null\" \"targetname\" \"spot\" \"origin\" \"0 0 0\" }\n"
                   "{ \"classname\" \"light\" }{ \"classname\" \"light\" \"origin\" \"0 0 nan\" }{ \"classname\" \"light\" \"origin\" \"0 0 0\" \"light\" \"-1\" }";
    const Scene scene = map.read();
    ASSERT_EQ(scene.lights.size(), 2u);
    expect_near(scene.lights[0].position, {32, 64, 96});
    EXPECT_EQ(scene.lights[0].type, Light::Type::point);
    expect_near(scene.lights[0].intensity, vec3(1, 0.5f, 0) * (3.14159265f * 7500 / 1024), 1e-3f);
    EXPECT_EQ(scene.lights[1].type, Light::Type::spot);
    expect_near(scene.lights[1].direction, {0, 0, -1});
    EXPECT_NEAR(std::tan(scene.lights[1].outer_cone), 80.0f / 128, 1e-5f);
}

TEST(Ibsp, players_become_cameras) {
    Map map = Map::ground();
    map.entities = "{ \"classname\" \"info_player_deathmatch\" \"origin\" \"0 0 6\" \"angle\" \"90\" }"
                   "{ \"classname\" \"info_player_deathmatch\" \"origin\" \"0 0 6\" }"
                   "{ \"classname\" \"info_player_intermission\" \"origin\" \"64 0 38\" \"angles\" \"30 180 0\" }"
                   "{ \"classname\" \"info_player_start\" \"origin\" \"0 0 6\" \"target\" \"up\" }"
                   "{ \"classname\" \"target_position\" \"targetname\" \"up\" \"origin\" \"0 32 64\" }";
    const Scene scene = map.read();
    ASSERT_EQ(scene.cameras.size(), 4u);
    const auto way = [&](size_t i) { return vec3(scene.cameras[i].to_world * glm::vec4(0, 0, -1, 0)); };
    EXPECT_EQ(scene.cameras[0].name, "intermission");
    expect_near(scene.cameras[0].to_world[3], {64, 0, 64});
    expect_near(way(0), {-std::sqrt(0.75f), 0, -0.5f});
    EXPECT_EQ(scene.cameras[1].name, "deathmatch");
    expect_near(scene.cameras[1].to_world[3], {0, 0, 32});
    expect_near(way(1), {0, 1, 0});
    EXPECT_EQ(scene.cameras[2].name, "deathmatch2");
    expect_near(way(2), {1, 0, 0});
    expect_near(way(3), glm::normalize(vec3(0, 1, 1)));
    for (const Camera& c : scene.cameras) {
        EXPECT_EQ(c.to_world[0].z, 0) << "level horizon";
        EXPECT_GT(c.to_world[1].z, 0) << "not upside down";
        EXPECT_NEAR(glm::determinant(glm::mat3(c.to_world)), 1, 1e-5f);
    }
}

TEST(Ibsp, names_make_looks) {
    Scene scene;
    add_look(scene, "textures/gothic_light/ironcrosslt2_5000", 1);
    add_look(scene, "textures/gothic_light/pentagram_light1_3k", 1);
    add_look(scene, "textures/liquids/lavahell_750", 0x8);
    add_look(scene, "textures/liquids/water4", 0x20);
    add_look(scene, "textures/Base_Wall/brick12", 1);
    add_look(scene, "textures/base_wall/BRICK12", 1);
    add_look(scene, "", 1);
    EXPECT_NEAR(scene.materials[0].emissive.x, 5000 * 3.0f / 255, 1e-3f);
    EXPECT_NEAR(scene.materials[1].emissive.x, 3000 * 3.0f / 255, 1e-3f);
    EXPECT_NEAR(scene.materials[2].emissive.x, 750 * 3.0f / 255, 1e-3f);
    EXPECT_EQ(scene.materials[3].alpha, Material::Alpha::blend);
    EXPECT_EQ(scene.materials[4].emissive, vec3(0));
    const Texture &a = scene.textures.at(scene.materials[4].base_color_texture.texture), &b = scene.textures.at(scene.materials[5].base_color_texture.texture);
    EXPECT_EQ(a.rgba, b.rgba) << "the same name, the same look";
    EXPECT_EQ(a.rgba.size(), size_t(a.width) * a.height * 4);
    EXPECT_GT(std::set<uint8_t>(a.rgba.begin(), a.rgba.end()).size(), 8u) << "a pattern";
}

TEST(Ibsp, an_empty_world_is_a_scene) {
    Map map;
    map.model(0, 0);
    Scene scene = map.read();
    EXPECT_TRUE(flatten(scene).triangles.empty());
    EXPECT_EQ(scene.materials.size(), 1u);
}

// The file cut off anywhere: one sentence or the same scene (the end may hold nothing that is read), never worse.
TEST(Ibsp, truncated_files_are_refused) {
    Map map = arch();
    map.entities = "{ \"classname\" \"light\" \"origin\" \"0 0 0\" }";
    const Bytes whole = map.bytes();
    for (size_t size = 0; size < whole.size(); ++size) {
        const std::string message = refusal(Bytes(whole.begin(), whole.begin() + long(size)));
        EXPECT_EQ(message.find("test.bsp: "), 0u) << size << ": " << message;
        EXPECT_TRUE(message.ends_with(".")) << message;
    }
}

TEST(Ibsp, lies_are_refused) {
    const auto with = [](const std::function<void(Map&)>& lie) {
        Map map = Map::ground();
        lie(map);
        return refusal(map);
    };
    const auto says = [](const std::string& message, const char* what) { EXPECT_NE(message.find(what), std::string::npos) << message; };
    says(with([](Map& m) { m.faces[0] = 1; }), "face 0 has shader 1 of 1");
    says(with([](Map& m) { m.faces[3] = 5; }), "face 0 has vertices beyond");
    says(with([](Map& m) { m.faces[4] = ~0u; }), "face 0 has vertices beyond");
    says(with([](Map& m) { m.faces[3] = ~0u, m.faces[4] = 2; }), "face 0 has vertices beyond");
    says(with([](Map& m) { m.faces[5] = 3; }), "face 0 has triangles beyond");
    says(with([](Map& m) { m.faces[6] = ~0u; }), "face 0 has triangles beyond");
    says(with([](Map& m) { m.faces[6] = 4; }), "face 0 has triangles beyond");
    says(with([](Map& m) { m.meshverts[2] = 4; }), "face 0 has a triangle with vertex 4 of 4");
    says(with([](Map& m) { m.meshverts[2] = ~0u; }), "face 0 has a triangle with vertex");
    says(with([](Map& m) { m.models[7] = 2; }), "model 0 has faces beyond");
    says(with([](Map& m) { m.models[6] = ~0u, m.models[7] = 2; }), "model 0 has faces beyond");
    says(with([](Map& m) { m.models.clear(); }), "no model");
    says(with([](Map& m) { m.models.pop_back(); }), "whole number of records");
    says(with([](Map& m) { m.entities = "{ \"model\" \"*1\" }"; }), "an entity has model *1");
    says(with([](Map& m) { for (int i = 0; i < 70000; ++i) m.entities += "{"; }), "more than 65536 entities");

    const auto patch = [](uint32_t w, uint32_t h) {
        Map map = arch();
        map.faces[24] = w, map.faces[25] = h;
        return refusal(map);
    };
    for (const auto& [w, h] : std::vector<std::pair<uint32_t, uint32_t>>{{2, 3}, {3, 2}, {1, 9}, {9, 1}, {0, 0}, {5, 3}, {0x80000001u, 0x80000001u}, {~0u, ~0u}})
        EXPECT_NE(patch(w, h).find("face 0 is a patch of "), std::string::npos) << w << " x " << h;

    Bytes bytes = Map::ground().bytes();
    bytes[0] = 'V';
    says(refusal(bytes), "does not begin with");
    bytes = Map::ground().bytes();
    bytes[4] = 47;
    says(refusal(bytes), "version 47");
    for (size_t lump : {1u, 7u, 10u, 11u, 13u})
        for (size_t word : {0u, 4u}) {
            bytes = Map::ground().bytes();
            std::memset(&bytes[8 + 8 * lump + word], 0xff, 4);
            const std::string message = refusal(bytes);
            EXPECT_EQ(message.find("test.bsp: "), 0u) << message;
        }
}

// Faces that all use the same vertices: 100 kB that ask for billions of triangles.
TEST(Ibsp, a_small_file_cannot_ask_for_much) {
    Map map;
    map.shader("x");
    for (int i = 0; i < 30000; ++i) map.meshverts.push_back(0);
    map.vertex({0, 0, 0});
    for (int i = 0; i < 2000; ++i) map.face(0, 1, 0, 1, 0, 30000);
    map.model(0, 2000);
    EXPECT_NE(refusal(map).find("more than 8388608 vertices and triangles"), std::string::npos);
    Map curves;  // patches that are bent so much, both ways, that they are cut as finely as patches are
    curves.shader("x");
    for (int i = 0; i < 9; ++i) curves.vertex({float(i % 3), float(i / 3), i % 2 ? 1e9f : 0});
    for (int i = 0; i < 2000; ++i) curves.face(0, 2, 0, 9, 0, 0, 3, 3);
    curves.model(0, 2000);
    EXPECT_NE(refusal(curves).find("more than 8388608"), std::string::npos);
}

TEST(Ibsp, numbers_that_are_none_are_dropped_with_a_warning) {
    Map map = arch();
    for (size_t i = 0; i < 9; ++i) map.vertices[11 * i] = Map::bits(i % 2 ? NAN : INFINITY);
    Scene scene = map.read();
    EXPECT_TRUE(flatten(scene).triangles.empty());
    EXPECT_EQ(scene.warnings.size(), 1u);
}

// One byte changed, anywhere: an error or a scene, never a crash (the sanitised build looks on).
TEST(Ibsp, any_byte_may_be_wrong) {
    Map map = arch();
    map.square(0);
    map.models.clear();
    map.model(0, 2);
    map.entities = "{ \"classname\" \"light\" \"origin\" \"0 0 0\" } { \"model\" \"*0\" }";
    const Bytes whole = map.bytes();
    for (size_t at = 0; at < whole.size(); ++at)
        for (uint8_t value : {0x7f, 0xff}) {
            Bytes bytes = whole;
            bytes[at] = value;
            try {
                Scene scene = read_ibsp(View(bytes, "test.bsp"));
                flatten(scene);
            } catch (const InputError& e) {
                EXPECT_EQ(std::string(e.what()).find("test.bsp: "), 0u);
            }
        }
}

}  // namespace
}  // namespace myriad::scenes::importing
