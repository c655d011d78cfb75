// The tea table: big enough, closed china, a room without gaps, and sun on the cloth.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/builtin/teatime_parts.hpp"
#include "scenes/builtin_kit.hpp"
#include "scenes/moment.hpp"
#include "scenes/stance.hpp"

namespace myriad::scenes {
namespace {

using glm::vec3;

struct Teatime : BuiltinTest<Teatime> {
    static constexpr const char* source = "builtin:teatime?detail=0.5";
};

TEST_F(Teatime, DetailScalesIt) {
    Scene whole = load("builtin:teatime");
    const size_t count = flatten(whole, Sharing::never).triangles.size();
    EXPECT_GE(count, 300000u);
    EXPECT_LE(count, 800000u);
    EXPECT_LT(triangles->triangles.size(), count / 2);
    for (const char* source : {"builtin:teatime?detail=0.1", "builtin:teatime?detail=4.1", "builtin:teatime?detail=x", "builtin:teatime?sugar=2"}) EXPECT_THROW(load(source), InputError) << source;
}

TEST_F(Teatime, CamerasSeeFrontsOnly) {
    std::set<std::string> names;
    for (const Camera& camera : scene->cameras) {
        names.insert(camera.name);
        const Seen seen = seen_from(*scene, *triangles, camera);
        EXPECT_LE(seen.nothing, 1u) << camera.name;  // the sky, between louvres
        EXPECT_EQ(seen.backs, 0u) << camera.name;
    }
    EXPECT_EQ(names, (std::set<std::string>{"table", "room", "teapot"}));
}

TEST_F(Teatime, TheRoomIsClosedButForItsWindows) {
    size_t out = 0;
    for (const vec3& from : {vec3(0.3f, 1.6f, 0.5f), vec3(2.2f, 0.3f, 2.5f), vec3(-1.2f, 2.3f, 0.4f)})
        for (int i = 0; i < 120; ++i) {
            const float y = 1 - (2 * float(i) + 1) / 120, r = std::sqrt(1 - y * y), angle = 2.399963f * float(i);
            const vec3 way(std::abs(r * std::cos(angle)), y, r * std::sin(angle));  // not to the windows
            out += first_hit(*triangles, from, way) == none;
        }
    EXPECT_EQ(out, 0u);
    EXPECT_EQ(first_hit(*triangles, {0, 4, 0}, {0, 1, 0}), size_t(none));  // the check can fail
}

// The sun gets past garden and louvres, and strikes part of the table and of the floor.
TEST_F(Teatime, SunStrikesTheTable) {
    const vec3 to_sun = -scene->lights.at(0).direction;
    int lit = 0, dark = 0;
    for (float x = -0.55f; x <= 0.55f; x += 0.05f)
        for (float z = -0.55f; z <= 0.55f; z += 0.05f)
            if (x * x + z * z < 0.3f) (first_hit(*triangles, {x, 0.745f, z}, to_sun) == none ? lit : dark)++;
    EXPECT_GE(lit, 40);
    EXPECT_GE(dark, 40);
}

// The clip is a round, moves what it should and no more, and leaves the scene at rest as it is.
TEST(TeatimeClip, SpoonStirsCakeTurnsCurtainsBillow) {
    Scene scene = load("builtin:teatime?detail=0.25"), again = scene;
    const Triangles rest = flatten(scene, Sharing::never);
    Triangles t = flatten(again, Sharing::never, pick_clips(again, "tea"));
    EXPECT_EQ(t.count(), rest.count());
    EXPECT_GT(t.motion.count(), 1000u);
    EXPECT_GT(t.motion.first_vertex, t.motion.count());
    EXPECT_GT(t.motion.deltas.size(), 500u);
    const auto positions = [&](double seconds) {
        deform(t, moment_at(again, t.motion, seconds));
        return t.positions;
    };
    const auto begin = positions(0), end = positions(std::nextafter(8.0, 0.0));
    float most = 0;
    for (size_t i = 0; i < begin.size(); ++i) most = std::max(most, glm::length(begin[i] - end[i]));
    EXPECT_LT(most, 1e-4f) << "the end is the beginning";
    // After a second the spoon is on the other side, the cake has turned by 45 degrees, and the wave has travelled a quarter.
    const auto later = positions(1);
    const std::vector<Stance> stance = stances(again, t.motion.playback);
    std::map<std::string, float> ways;  // by what moves: the longest
    size_t vertex = t.motion.first_vertex;
    for (size_t i = 0; i < stance.size(); ++i) {
        if (stance[i] != Stance::moving) continue;
        const Node& own = again.nodes[again.instances[i].node];
        float& way = ways[own.name.empty() ? again.nodes[own.parent].name : own.name];
        for (const Primitive& p : again.meshes[again.instances[i].mesh].primitives)
            for (const size_t last = vertex + (p.normals.empty() ? p.indices.size() : p.positions.size()); vertex < last; ++vertex)
                way = std::max(way, glm::length(later.at(vertex) - begin.at(vertex)));
    }
    EXPECT_EQ(vertex, begin.size());
    EXPECT_EQ(ways.size(), 3u);
    for (const char* name : {"spoon", "turntable", "curtains"}) EXPECT_GT(ways[name], 0.01f) << name;
    // The spoon stays inside of its cup: below the rim, no point of it is farther from the axis than the china's inside.
    const size_t spoon = size_t(std::ranges::find_if(again.instances, [&](const Instance& i) { return i.node != none && again.nodes[i.node].name == "spoon"; }) - again.instances.begin());
    ASSERT_LT(spoon, again.instances.size());
    const uint32_t node = again.instances[spoon].node;
    for (double seconds = 0; seconds < 2; seconds += 0.125) {
        const Pose pose = pose_at(again, t.motion.playback, seconds);
        const glm::dmat4 in_cup = glm::inverse(pose.worlds[again.nodes[node].parent]) * pose.worlds[node];
        for (const vec3& v : again.meshes[again.instances[spoon].mesh].primitives[0].positions) {
            const vec3 p(in_cup * glm::dvec4(v, 1));
            if (p.y > 0.060f) continue;
            EXPECT_GT(p.y, 0.0105f) << seconds;
            EXPECT_LT(std::hypot(p.x, p.z), p.y > 0.046f ? 0.0393f : p.y > 0.029f ? 0.0352f : 0.027f) << seconds << " s, at a height of " << p.y;
        }
    }
}

TEST(TeatimeParts, PiecesTurnedInOneAreClosed) {
    // Where painted and plain parts meet they share their edge; handles and spouts run into the body and are closed themselves.
    for (const auto& [name, make] : {std::pair<const char*, void (*)(teatime::China&, float)>{"teapot", teatime::teapot}, {"cup", teatime::cup}, {"creamer", teatime::creamer}, {"sugar bowl", teatime::sugar_bowl}}) {
        teatime::China piece;
        make(piece, 1);
        Primitive both = piece.plain;
        kit::append(both, piece.painted, glm::mat4(1));
        EXPECT_GT(signed_volume(both), 0) << name;
        if (std::string(name) != "teapot") {
            EXPECT_EQ(open_edges(both), 0u) << name;  // the pot's inside is hidden by its lid, and left out
        }
    }
    Primitive macaron, filling, spoon;
    teatime::macaron(macaron, filling, 1);
    teatime::spoon(spoon, 1);
    EXPECT_EQ(open_edges(macaron), 0u);
    EXPECT_GT(signed_volume(macaron), 0);
    EXPECT_EQ(open_edges(spoon), 0u);
    EXPECT_GT(signed_volume(spoon), 0);
}

TEST(TeatimeParts, TableclothKeepsItsLengthAndLiesOnTheTable) {
    Primitive cloth;
    teatime::tablecloth(cloth, 0.62f, 1.9f, 7, 1);
    float lowest = 0, highest = -1;
    for (const vec3& p : cloth.positions) {
        lowest = std::min(lowest, p.y), highest = std::max(highest, p.y);
        if (std::hypot(p.x, p.z) < 0.61f && p.y > -0.2f) {
            EXPECT_GT(p.y, 0);  // nothing of the table shows through; folds go under it further down
        }
    }
    for (size_t i = 0; i < cloth.indices.size(); i += 3) {
        const auto at = [&](size_t k) { return cloth.positions[cloth.indices[i + k]]; };
        if (std::hypot(at(0).x, at(0).z) < 0.5f) {
            ASSERT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).y, 0);  // its front is above
        }
    }
    EXPECT_LT(highest, 0.006f);                      // cups stand on it
    EXPECT_GT(lowest, -0.735f);                      // and it does not reach the floor
    EXPECT_LT(lowest, -(0.95f * std::sqrt(2.0f) - 0.62f) * 0.8f);  // its corners hang as far as they are long
    for (const auto& uv : cloth.texcoords) EXPECT_TRUE(uv.x > -1e-4f && uv.x < 1.0001f && uv.y > -1e-4f && uv.y < 1.0001f);
}

}  // namespace
}  // namespace myriad::scenes
