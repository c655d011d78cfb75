// Which meshes flatten() stores once, and that the world is the same whatever it chooses.
#include "scenes/sharing.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace myriad::scenes {
namespace {

using glm::mat4;
using glm::vec3;

// A height field of 2 n^2 triangles over the unit square, with smooth normals or without.
Mesh field(uint32_t n, bool smooth) {
    Primitive p;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x) {
            p.positions.push_back(vec3(x, 0.1f * std::sin(float(x * y)), y) / float(n));
            p.texcoords.push_back({x, y});
            if (smooth) p.normals.push_back(glm::normalize(vec3(std::sin(float(x)), 4, std::cos(float(y)))));
        }
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + n + 1;
            p.indices.insert(p.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    return {"field", {p}};
}

Scene scene_of(std::vector<Mesh> meshes) {
    Scene scene;
    scene.name = "test";
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    return scene;
}

mat4 anywhere(std::mt19937& random) {
    std::uniform_real_distribution<float> any(-1, 1);
    mat4 m = glm::translate(mat4(1), 5.0f * vec3(any(random), any(random), any(random)));
    m = glm::rotate(m, 3 * any(random), glm::normalize(vec3(any(random), 1.5f, any(random))));
    return glm::scale(m, vec3(std::exp(any(random)), random() % 3 ? 1 : -1, std::exp(any(random))));
}

// Every triangle's corners in the world, by ids.
std::vector<vec3> corners(const Triangles& t) {
    std::vector<vec3> out;
    const auto add = [&](const Placement& p) {
        EXPECT_EQ(p.first_id * 3, out.size());
        const bool swap = glm::determinant(glm::dmat3(p.to_world)) < 0;
        for (uint32_t i = 0; i < p.count; ++i) {
            const glm::uvec4 c = t.triangles[p.first_triangle + i];
            for (const uint32_t k : {c.x, swap ? c.z : c.y, swap ? c.y : c.z})
                out.push_back(p.in_world ? t.positions[k] : vec3(p.to_world * glm::vec4(t.positions[k], 1)));
        }
    };
    if (t.placements.empty()) add({.count = uint32_t(t.triangles.size())});
    for (const Placement& p : t.placements) add(p);
    return out;
}

TEST(Sharing, the_world_is_the_same_to_the_bit) {
    std::mt19937 random(4);
    Scene scene = scene_of({field(9, true), field(5, false), field(1, true)});
    for (int i = 0; i < 30; ++i) scene.instances.push_back({uint32_t(i % 3 == 2 ? 2 : random() % 2), anywhere(random)});
    scene.instances[7].to_world = glm::scale(mat4(1), vec3(1, 0, 1));  // singular: written out, in its place
    const Triangles flat = flatten(scene, Sharing::never), shared = flatten(scene, Sharing::always);
    EXPECT_TRUE(flat.placements.empty());
    EXPECT_EQ(flat.count(), flat.triangles.size());
    ASSERT_EQ(shared.count(), flat.count());
    EXPECT_EQ(corners(shared), corners(flat));
    EXPECT_EQ(shared.lo, flat.lo);
    EXPECT_EQ(shared.hi, flat.hi);
    EXPECT_LE(shared.triangles.size(), 162u + 50 + 2 + 162);
    size_t in_world = 0;
    for (const Placement& p : shared.placements) in_world += p.in_world;
    EXPECT_EQ(in_world, 1u);
}

TEST(Sharing, what_is_used_once_or_is_small_is_written_out) {
    std::mt19937 random(4);
    Scene once = scene_of({field(300, true), field(200, true)});
    once.instances = {{0, mat4(1)}, {1, anywhere(random)}};
    EXPECT_TRUE(flatten(once).placements.empty());
    EXPECT_TRUE(flatten(once, Sharing::always).placements.empty());

    Scene quads = scene_of({field(1, true)});
    for (int i = 0; i < 200000; ++i) quads.instances.push_back({0, glm::translate(mat4(1), vec3(i % 500, 0, i / 500))});
    EXPECT_TRUE(flatten(quads).placements.empty()) << "2 triangles: an instance takes more";

    Scene few = scene_of({field(20, true)});
    for (int i = 0; i < 20; ++i) few.instances.push_back({0, anywhere(random)});
    EXPECT_TRUE(flatten(few).placements.empty()) << "1.4 MB saved are not worth it";
    EXPECT_FALSE(flatten(few, Sharing::always).placements.empty());
    for (int i = 0; i < 400; ++i) few.instances.push_back({0, anywhere(random)});
    const Triangles many = flatten(few);
    EXPECT_EQ(many.placements.size(), 420u);
    EXPECT_EQ(many.triangles.size(), 800u);

    // The same beside a much larger mesh that stands once: it would pay for the saving with all its rays.
    few.meshes.push_back(field(900, true));
    few.instances.push_back({1, mat4(1)});
    EXPECT_TRUE(flatten(few).placements.empty());
}

TEST(Sharing, instances_that_rays_cannot_enter_are_written_out) {
    const MeshUse mesh{.instances = 2, .triangles = 100, .bytes = 1, .lo = glm::dvec3(-1), .hi = glm::dvec3(1)};
    const mat4 one(1);
    EXPECT_TRUE(can_share(mesh, one));
    EXPECT_TRUE(can_share(mesh, glm::scale(one, vec3(-1, 2, 0.5f)))) << "mirrored";
    EXPECT_TRUE(can_share(mesh, glm::scale(one, vec3(1e-6f))));
    EXPECT_TRUE(can_share(mesh, glm::scale(one, vec3(1e6f))));
    EXPECT_TRUE(can_share(mesh, glm::translate(one, vec3(2000, 0, 0))));
    EXPECT_FALSE(can_share(mesh, glm::translate(one, vec3(1e5f, 0, 0)))) << "floats there are too coarse for it";
    EXPECT_FALSE(can_share(mesh, glm::scale(one, vec3(1, 0, 1)))) << "singular";
    EXPECT_FALSE(can_share(mesh, glm::scale(one, vec3(0))));
    EXPECT_FALSE(can_share(mesh, glm::rotate(one, 0.7f, glm::normalize(vec3(1, 2, 3))) * glm::scale(one, vec3(1, 1e-5f, 1)))) << "nearly";
    EXPECT_FALSE(can_share(mesh, glm::scale(one, vec3(1e-20f))));
    EXPECT_FALSE(can_share(mesh, glm::scale(one, vec3(1e20f))));
    for (const float bad : {std::numeric_limits<float>::infinity(), std::nanf("")})
        for (int k = 0; k < 12; ++k) {
            mat4 m(1);
            m[k / 3][k % 3] = bad;
            EXPECT_FALSE(can_share(mesh, m)) << k;
        }
    mat4 projective(1);
    projective[0][3] = 0.1f;
    EXPECT_FALSE(can_share(mesh, projective));
}

TEST(Sharing, defects_are_dropped_alike) {
    std::mt19937 random(4);
    Scene scene = scene_of({field(9, true)});
    scene.meshes[0].primitives[0].positions[17].y = std::nanf("");
    for (int i = 0; i < 5; ++i) scene.instances.push_back({0, anywhere(random)});
    const Triangles shared = flatten(scene, Sharing::always), flat = flatten(scene, Sharing::never);
    EXPECT_EQ(shared.triangles.size(), 156u);
    EXPECT_EQ(corners(shared), corners(flat));
    // Beyond `farthest` in the world, or in the mesh; near it, where rounding decides.
    for (const float size : {1e8f, 0.4e9f, 0.9989e9f, 0.99999994e9f, 1e9f, 1.5e9f, 1e11f}) {
        Scene large = scene_of({field(9, true)}), small = large;
        for (const float scale : {1.0f, 0.9f}) large.instances.push_back({0, glm::scale(mat4(1), vec3(scale * size))});
        for (vec3& p : small.meshes[0].primitives[0].positions) p *= size;
        for (const float scale : {1.0f, 0.9f}) small.instances.push_back({0, glm::scale(mat4(1), vec3(scale / size))});
        for (Scene* far : {&large, &small}) EXPECT_EQ(corners(flatten(*far, Sharing::always)), corners(flatten(*far, Sharing::never))) << size;
    }
    Scene empty = scene_of({Mesh{}});
    empty.instances = {{0, mat4(1)}, {0, mat4(1)}};
    EXPECT_EQ(flatten(empty, Sharing::always).count(), 0u);
}

}  // namespace
}  // namespace myriad::scenes
