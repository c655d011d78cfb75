// Whole frames of scenes whose instances share a mesh, against the same scene written out; and what that saves.
#include <glm/gtc/matrix_transform.hpp>

#include "compute/common/packing.h"
#include "engine/testing.hpp"
#include "engine/transfer.hpp"
#include "passes/frame.hpp"

namespace myriad::tests {
namespace {

using glm::mat4;
using glm::vec3;
using passes::Visibility;
using scenes::Sharing;

// A bumpy ball of 2 n^2 triangles or so, with normals that are not those of its faces.
scenes::Primitive ball(uint32_t n, uint32_t material) {
    scenes::Primitive p;
    p.material = material;
    for (uint32_t r = 0; r <= n; ++r)
        for (uint32_t k = 0; k <= n; ++k) {
            const float a = 3.14159265f * float(r) / float(n), b = 6.2831853f * float(k) / float(n);
            const vec3 d(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
            p.positions.push_back(d * (1 + 0.1f * std::sin(5 * a) * std::sin(4 * b)));
            p.normals.push_back(d);
            p.texcoords.push_back({float(k) / float(n), float(r) / float(n)});
        }
    for (uint32_t r = 0; r < n; ++r)
        for (uint32_t k = 0; k < n; ++k) {
            const uint32_t i = r * (n + 1) + k, j = i + n + 1;
            p.indices.insert(p.indices.end(), {i, i + 1, j, i + 1, j + 1, j});
        }
    return p;
}

scenes::Primitive ground(float half, uint32_t material) {
    scenes::Primitive p;
    p.material = material;
    p.positions = {{-half, 0, -half}, {half, 0, -half}, {half, 0, half}, {-half, 0, half}};
    p.indices = {0, 2, 1, 0, 3, 2};
    return p;
}

scenes::Scene scene_with(std::vector<scenes::Mesh> meshes) {
    scenes::Scene scene;
    scene.name = "test";
    scene.meshes = std::move(meshes);
    for (const vec3 colour : {vec3(0.6f, 0.6f, 0.5f), vec3(0.7f, 0.3f, 0.2f), vec3(0.2f)}) {
        scenes::Material m;
        m.base_color = glm::vec4(colour, 1);
        m.metallic = 0;
        scene.materials.push_back(m);
    }
    scene.lights.push_back({scenes::Light::Type::directional, "", vec3(0), glm::normalize(vec3(0.5f, -1, -0.3f)), vec3(3)});
    return scene;
}

void look(scenes::Scene& scene, const vec3& from, const vec3& at) {
    scene.cameras = {{"test", mat4(glm::inverse(glm::lookAt(glm::dvec3(from), glm::dvec3(at), glm::dvec3(0, 1, 0)))), 0.9f}};
}

// Balls on a ground, turned, stretched and mirrored, each with a lamp of its own and a part without normals.
scenes::Scene balls() {
    scenes::Primitive lamp = ball(6, 2), flat = ball(8, 0);
    for (vec3& p : lamp.positions) p = 0.2f * p + vec3(0, 1.3f, 0);
    for (vec3& p : flat.positions) p = 0.5f * p + vec3(0.9f, 0, 0.2f);
    flat.normals.clear();
    scenes::Scene scene = scene_with({{"ball", {ball(16, 1), flat, lamp}}, {"ground", {ground(8, 0)}}});
    scene.materials[2].emissive = vec3(4, 3, 2);
    scenes::Texture checks;
    checks.width = checks.height = 8;
    for (uint32_t i = 0; i < 64; ++i)
        for (int c = 0; c < 4; ++c) checks.rgba.push_back(c == 3 || (i + i / 8) % 2 ? 255 : 90);
    scene.textures.push_back(checks);
    scene.materials[1].base_color_texture = {0};
    for (int i = 0; i < 25; ++i) {
        mat4 m = glm::translate(mat4(1), vec3(2.6f * float(i % 5 - 2), 1, 2.6f * float(i / 5 - 2)));
        m = glm::rotate(m, 0.4f * float(i), glm::normalize(vec3(0.3f, 1, 0.1f * float(i % 3))));
        scene.instances.push_back({0, glm::scale(m, vec3(i % 2 ? 1 : -1, 0.6f + 0.1f * float(i % 7), 0.8f))});
        if (i == 11) scene.instances.push_back({1, mat4(1)});
    }
    look(scene, {3, 5, 11}, {0, 0.8f, 0});
    return scene;
}

// The same with holes in everything that is shared: balls are cut out by their texture and bent by another, their flat parts blended by
// vertex colours, their lamps cut out of what shines.
scenes::Scene holed_balls() {
    scenes::Scene scene = balls();
    using Alpha = scenes::Material::Alpha;
    scenes::Texture& checks = scene.textures[0];
    for (uint32_t i = 0; i < 64; ++i) checks.rgba[4 * i + 3] = i % 3 ? 255 : 20;
    scenes::Texture bumps = checks;
    for (uint32_t i = 0; i < 64; ++i) bumps.rgba[4 * i] = uint8_t(128 + 60 * (int(i % 3) - 1)), bumps.rgba[4 * i + 1] = 128, bumps.rgba[4 * i + 2] = 240;
    scene.textures.push_back(bumps);
    scene.materials[1].alpha = Alpha::mask, scene.materials[1].base_color_texture.transform = glm::mat3x2(3, 0, 0.5f, 2, 0.1f, 0);
    scene.materials[1].normal_texture = {1};
    scene.materials[2].alpha = Alpha::mask, scene.materials[2].base_color_texture = {0};
    scene.materials.push_back(scene.materials[0]);
    scene.materials[3].alpha = Alpha::blend;
    scenes::Primitive& flat = scene.meshes[0].primitives[1];
    flat.material = 3;
    for (const vec3& p : flat.positions) flat.colors.emplace_back(1, 1, 1, 0.5f + 0.5f * p.y);
    for (const vec3& n : scene.meshes[0].primitives[0].normals) scene.meshes[0].primitives[0].tangents.emplace_back(glm::normalize(glm::cross(n, vec3(0.3f, 1, 0.2f))), 1);
    return scene;
}

class FrameInstances : public engine::DeviceTest {
protected:
    struct Picture {
        std::vector<vec4> beauty, positions;
        std::vector<uvec2> normals;
        uint64_t scene_bytes = 0;
        passes::SceneSize size;
        uint64_t vpls = 0;
    };
    static Picture render(engine::Device& on, scenes::Scene scene, Sharing sharing, passes::FrameSettings settings) {
        const scenes::Triangles triangles = scenes::flatten(scene, sharing);
        on.reset_memory_peaks();
        passes::Frame frame(on, scene, triangles, settings);
        frame.render(scene.cameras[0]);
        return {engine::download(on, frame.beauty()), engine::download(on, frame.gbuffer().positions), engine::download(on, frame.gbuffer().normals),
                on.memory().at("scene").now, frame.size(), frame.counters().vpls.value_or(0)};
    }
    static passes::FrameSettings small(Visibility visibility) {
        passes::FrameSettings s;
        s.width = 96, s.height = 64, s.vpls = 256, s.subset = 64, s.log2_samples = 14, s.visibility = visibility;
        return s;
    }
};

// Hits, VPLs and samples are the same to the bit. Only interpolated normals are transformed in another precision (float, not double
// before rounding): they differ by some ulp, and by a step of their packing where that decides; light by as much.
TEST_F(FrameInstances, images_are_those_of_the_scene_written_out) {
    for (const auto& [visibility, scene] : {std::pair{Visibility::rays, balls()}, {Visibility::manylods, balls()}, {Visibility::rays, holed_balls()},
                                            {Visibility::manylods, holed_balls()}}) {
        const Picture shared = render(device, scene, Sharing::always, small(visibility)), flat = render(device, scene, Sharing::never, small(visibility));
        EXPECT_EQ(shared.size.instances, 25u);
        EXPECT_EQ(shared.size.triangles, flat.size.triangles);
        EXPECT_EQ(shared.size.lights, flat.size.lights);
        EXPECT_LT(shared.size.stored_triangles, flat.size.triangles / 20);
        EXPECT_EQ(shared.vpls, flat.vpls);
        EXPECT_GT(shared.vpls, 150u);
        EXPECT_TRUE(engine::same(flat.positions, shared.positions));
        double mean = 0, worst = 0, seen = 0;
        for (const vec4& v : flat.beauty) mean += double(v.x + v.y + v.z) / (3 * double(flat.beauty.size()));
        for (size_t i = 0; i < flat.beauty.size(); ++i) {
            worst = std::max(worst, double(glm::length(vec3(flat.beauty[i]) - vec3(shared.beauty[i]))));
            EXPECT_NEAR(glm::length(unpack_direction(flat.normals[i].x) - unpack_direction(shared.normals[i].x)), 0, 1e-4) << i;
            seen += flat.positions[i].w > 0;
        }
        EXPECT_GT(seen, 0.5 * double(flat.beauty.size()));
        EXPECT_GT(mean, 0.05);
        EXPECT_LT(worst, 2e-3 * mean) << "no pixel may be off by more";
    }
}

// And the holes are there: light falls through them, and the eye sees through them.
TEST_F(FrameInstances, shared_meshes_have_their_holes) {
    scenes::Scene holed = holed_balls(), solid = holed_balls();
    for (scenes::Material& m : solid.materials) m.alpha = scenes::Material::Alpha::opaque;
    const Picture with = render(device, holed, Sharing::always, small(Visibility::manylods)), without = render(device, solid, Sharing::always, small(Visibility::manylods));
    EXPECT_EQ(with.size.instances, 25u);
    size_t farther = 0, nearer = 0;
    for (size_t i = 0; i < with.positions.size(); ++i) {
        const float a = with.positions[i].w > 0 ? with.positions[i].w : 1e9f, b = without.positions[i].w > 0 ? without.positions[i].w : 1e9f;
        farther += a > b, nearer += a < b;
    }
    EXPECT_GT(farther, with.positions.size() / 20);
    EXPECT_EQ(nearer, 0u);
}

TEST_F(FrameInstances, a_mesh_takes_memory_once) {
    scenes::Scene scene = scene_with({{"ball", {ball(70, 1)}}, {"ground", {ground(20, 0)}}});
    scene.instances = {{1, mat4(1)}};
    for (int i = 0; i < 64; ++i) scene.instances.push_back({0, glm::translate(mat4(1), vec3(3 * (i % 8) - 12, 1, 3 * (i / 8) - 12))});
    look(scene, {3, 9, 25}, {0, 0.8f, 0});
    const passes::FrameSettings settings = small(Visibility::rays);
    const Picture shared = render(device, scene, Sharing::automatic, settings), flat = render(device, scene, Sharing::never, settings);
    EXPECT_EQ(shared.size.instances, 64u) << "automatic shares: this saves 45 MB";
    EXPECT_GT(flat.scene_bytes, 30 * shared.scene_bytes) << shared.scene_bytes;
}

// A forest: 10,000 times a mesh of 1,000 triangles. Written out its triangles alone would take 10^7 * (16 + 40) bytes, 534 MiB.
TEST_F(FrameInstances, ten_million_triangles_in_64_MiB) {
    scenes::Primitive tree = ball(22, 1);
    for (vec3& p : tree.positions) p = p * vec3(0.5f, 1.5f, 0.5f) + vec3(0, 1.5f, 0);
    tree.indices.resize(3000);
    scenes::Scene scene = scene_with({{"tree", {tree}}, {"ground", {ground(110, 0)}}});
    scene.instances = {{1, mat4(1)}};
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < 10000; ++i) {
        mat4 m = glm::translate(mat4(1), vec3(2 * (i % 100 - 50), 0, 2 * (i / 100 - 50)) + 0.5f * vec3(any(random), 0, any(random)));
        m = glm::rotate(m, 3 * any(random), vec3(0, 1, 0));
        scene.instances.push_back({0, glm::scale(m, vec3(1 + 0.3f * any(random)))});
    }
    look(scene, {0, 12, 70}, {0, 0, 0});
    engine::Device small_device({.select = "", .validation = true, .memory_limit = 64 << 20});
    passes::FrameSettings settings = small(Visibility::manylods);
    settings.maps.map_size = 16;
    const Picture p = render(small_device, scene, Sharing::automatic, settings);
    EXPECT_EQ(p.size.triangles, 10000u * 1000 + 2);
    EXPECT_LT(p.scene_bytes, uint64_t(8) << 20);
    double mean = 0;
    for (const vec4& v : p.beauty) mean += double(v.y) / double(p.beauty.size());
    EXPECT_GT(mean, 0.05);
    EXPECT_EQ(small_device.validation_messages(), 0u);
}

}  // namespace
}  // namespace myriad::tests
