// Glowing particles: they are as many as asked for, share their power, and stay in the court and out of its walls.
#include "scenes/scene.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/builtin_kit.hpp"
#include "scenes/moment.hpp"

namespace myriad::scenes {
namespace {

using glm::vec3;

Motion swarm(const Scene& scene) {
    Motion motion;
    motion.playback = pick_clips(scene, "swarm");
    return motion;
}

TEST(Particles, are_as_many_as_asked_for_and_share_one_power) {
    for (uint32_t count : {0u, 1u, 1000u, 70000u}) {
        const Scene scene = load("builtin:particles?detail=0.25&count=" + std::to_string(count));
        ASSERT_EQ(scene.lights.size(), count);
        EXPECT_EQ(scene.clips.size(), count > 0 ? 1u : 0u);
        double power = 0, area = 0;
        for (const Light& light : scene.lights) {
            EXPECT_EQ(light.type, Light::Type::point);
            EXPECT_TRUE(light.radius > 0 && light.radius < 0.1f);
            power += (double(light.intensity.x) + light.intensity.y + light.intensity.z) / 3, area += double(light.radius) * light.radius;
        }
        if (count > 0) { EXPECT_NEAR(power, 260, 1); }
        if (count >= 1000) { EXPECT_NEAR(area, 3.24, 0.1); }  // their discs together
    }
    EXPECT_THROW(load("builtin:particles?count=-1"), InputError);
    EXPECT_THROW(load("builtin:particles?count=2000000"), InputError);
}

TEST(Particles, move_the_same_every_time_and_otherwise_with_another_seed) {
    const std::string source = "builtin:particles?detail=0.25&count=200";
    const Scene a = load(source), b = load(source), other = load(source, 2);
    double moved = 0, differ = 0;
    for (double seconds : {0.0, 1.7, 15.99, 16.0, 20.0}) {
        const Moment at = moment_at(a, swarm(a), seconds), again = moment_at(b, swarm(b), seconds), otherwise = moment_at(other, swarm(other), seconds);
        for (size_t i = 0; i < 200; ++i) {
            ASSERT_EQ(at.lights[i].position, again.lights[i].position);
            ASSERT_EQ(at.lights[i].intensity, again.lights[i].intensity);
            moved += glm::length(at.lights[i].position - a.lights[i].position), differ += glm::length(at.lights[i].position - otherwise.lights[i].position);
            // The round closes.
            if (seconds == 16) { ASSERT_EQ(at.lights[i].position, a.lights[i].position); }
        }
    }
    EXPECT_GT(moved, 100);
    EXPECT_GT(differ, 100);
}

// From moment to moment no particle goes through a surface, and none leaves the building: ways are smooth, and moments near.
TEST(Particles, stay_in_the_court_and_go_through_nothing) {
    Scene scene = load("builtin:particles?detail=0.25&count=400");
    const Triangles triangles = flatten(scene, Sharing::never);
    // All triangles that a step from within a slab can meet: brute force over the whole building takes a minute where memory is checked.
    constexpr float slab = 1.5f, from = -18;
    std::vector<Triangles> slabs(24);
    for (size_t s = 0; s < slabs.size(); ++s) {
        slabs[s].positions = triangles.positions;
        for (const auto& t : triangles.triangles) {
            const auto [least, most] = std::minmax({triangles.positions[t.x].x, triangles.positions[t.y].x, triangles.positions[t.z].x});
            if (most >= from + slab * (float(s) - 1) && least <= from + slab * (float(s) + 2)) slabs[s].triangles.push_back(t);
        }
    }
    constexpr int moments = 64;
    std::vector<vec3> before;
    size_t steps = 0, outside = 0, through = 0, galleries = 0;
    for (int i = 0; i <= moments; ++i) {
        const Moment at = moment_at(scene, swarm(scene), 16.0 * i / moments);
        for (size_t k = 0; k < at.lights.size(); ++k) {
            const vec3 p = at.lights[k].position;
            outside += !(std::abs(p.x) < 15.2f && std::abs(p.z) < 7.7f && p.y > 0.2f && p.y < 10);
            galleries += std::abs(p.z) > 4.7f || std::abs(p.x) > 12.2f;
            if (i == 0) continue;
            const vec3 way = p - before[k];
            ASSERT_LT(glm::length(way), slab);
            // Brute force takes its time: a part of all steps, of all particles.
            if ((i + 5 * k) % 8 || glm::length(way) < 1e-3f) continue;
            ++steps;
            const float length = glm::length(way);
            const Triangles& near = slabs.at(size_t((before[k].x - from) / slab));
            const size_t hit = first_hit(near, before[k], way / length);
            if (hit == none) continue;
            const auto& t = near.triangles[hit];
            const vec3 a = triangles.positions[t.x], n = glm::cross(triangles.positions[t.y] - a, triangles.positions[t.z] - a);
            if (!(glm::dot(n, a - before[k]) / glm::dot(n, way) <= 1)) continue;
            ++through;
            ADD_FAILURE() << "particle " << k << " at " << p.x << ", " << p.y << ", " << p.z << " meets " << scene.materials[t.w].name;
        }
        before.clear();
        for (const Light& light : at.lights) before.push_back(light.position);
    }
    EXPECT_GT(steps, 1000u);
    EXPECT_EQ(outside, 0u);
    EXPECT_EQ(through, 0u);
    EXPECT_GT(galleries, 100u) << "some go around columns";
}

}  // namespace
}  // namespace myriad::scenes
