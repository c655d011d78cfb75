#include "compute/svo/svo.hpp"

#include <cmath>

#include "compute/opacity/opacity_testing.hpp"
#include "compute/svo/svo_ref.hpp"
#include "compute/voxels/voxels_ref.hpp"
#include "engine/testing.hpp"

namespace myriad {
static bool operator==(const SvoBlock& a, const SvoBlock& b) { return a.origin == b.origin && a.bits == b.bits && a.first == b.first; }
static void PrintTo(const SvoBlock& b, std::ostream* out) {
    *out << "origin " << b.origin.x << " " << b.origin.y << " " << b.origin.z << " bits " << std::hex << b.bits << std::dec << " first " << b.first;
}
}  // namespace myriad

namespace myriad::compute {
namespace {

using engine::same;

class SvoTest : public engine::DeviceTest {
protected:
    float uniform(float low = -1, float high = 1) { return low + (high - low) * float(random()) * 0x1p-32f; }
    vec3 point(float scale = 1, vec3 around = vec3(0)) { return around + scale * vec3(uniform(), uniform(), uniform()); }

    static SvoInput input_of(std::vector<Corners> triangles, uint depth) {
        vec3 low(0), high(0);
        bool any = false;
        for (const Corners& t : triangles)
            for (const vec3& p : {t.p0, t.p1, t.p2})
                if (voxel_is_finite(p)) low = any ? min(low, p) : p, high = any ? max(high, p) : p, any = true;
        return {std::move(triangles), octree_cube(low, high, depth), depth};
    }

    struct World {
        std::vector<vec3> positions;
        std::vector<uvec4> triangles;
        explicit World(const std::vector<Corners>& corners) {
            for (const Corners& c : corners) {
                const uint n = uint(positions.size());
                positions.insert(positions.end(), {c.p0, c.p1, c.p2});
                triangles.emplace_back(n, n + 1, n + 2, 0);
            }
        }
        WorldTriangles view() const { return {positions, triangles}; }
    };
    Svo build(const SvoInput& input, SvoRoom room = {}) {
        const World world(input.triangles);
        vec3 high = input.cube.origin;
        if (input.cube.cells_per_length > 0) high += float(1u << input.depth) / input.cube.cells_per_length;
        Svo svo(device, world.view(), input.depth, input.cube.origin, high, room);
        EXPECT_EQ(svo.cube().origin, input.cube.origin);
        const_cast<OctreeCube&>(svo.cube()) = input.cube;  // to the bit
        const auto positions = on_device(world.positions);
        const auto triangles = on_device(world.triangles);
        engine::Recorder recorder(device);
        svo.build(recorder, positions, triangles);
        return svo;
    }
    void expect_equal(const SvoArrays& twin, const SvoArrays& svo) {
        EXPECT_TRUE(same(twin.blocks, svo.blocks));
        EXPECT_TRUE(same(twin.spheres, svo.spheres));
        EXPECT_TRUE(same(twin.cones, svo.cones));
        ASSERT_EQ(twin.boxes.size(), svo.boxes.size());
        for (size_t i = 0; i < svo.boxes.size(); ++i) ASSERT_EQ(bsh_missing(twin.boxes[i]), bsh_missing(svo.boxes[i])) << i;
    }
    void check(const char* name, const std::vector<Corners>& triangles, uint depth) {
        SCOPED_TRACE(std::string(name) + ", " + std::to_string(depth) + " levels");
        const SvoInput input = input_of(triangles, depth);
        const Svo svo = build(input);
        const SvoArrays found = svo_download(device, svo), twin = svo_ref(input);
        EXPECT_EQ(svo_check(twin, input), "") << "(twin)";
        EXPECT_EQ(svo_check(found, input), "") << "(device)";
        expect_equal(twin, found);
    }

    std::vector<Corners> soup(size_t n, float size, float scale = 1, vec3 origin = vec3(0)) {
        std::vector<Corners> all;
        for (size_t i = 0; i < n; ++i) {
            const vec3 at = point(scale, origin);
            all.push_back({at + point(size * scale), at + point(size * scale), at + point(size * scale)});
        }
        return all;
    }
};

TEST_F(SvoTest, holds_what_it_is_made_of_and_equals_its_twin) {
    for (const uint depth : {1u, 2u, 5u, 7u}) {
        check("small triangles", soup(300, 0.02f), depth);
        check("large triangles", soup(20, 1), depth);
        check("one triangle", soup(1, 1), depth);
        if (HasFailure()) return;
    }
    check("deep", soup(5, 0.01f), 12);
}

TEST_F(SvoTest, hard_cases) {
    std::vector<Corners> huge = soup(100, 1e-3f);
    huge.push_back({{-50, -0.1f, -50}, {50, 0.1f, -50}, {0, 0.05f, 60}});
    std::vector<Corners> same_one(20, soup(1, 0.5f)[0]);
    std::vector<Corners> needles;
    for (const float width : {1e-2f, 1e-4f, 1e-6f, 0.0f})
        for (int i = 0; i < 5; ++i) {
            const vec3 a = point(), b = point();
            needles.push_back({a, b, mix(a, b, 0.3f) + point(width)});
        }
    std::vector<Corners> walls;
    for (int axis = 0; axis < 3; ++axis)
        for (const float where : {-1.0f, -0.5f, 0.0f, 0.3f, 1.0f}) {
            Corners c{point(), point(), point()};
            c.p0[axis] = c.p1[axis] = c.p2[axis] = where;
            walls.push_back(c);
        }
    std::vector<Corners> broken = soup(30, 0.1f);
    broken.push_back({{0, 0, NAN}, {1, 0, 0}, {0, 1, 0}});
    broken.push_back({{0, 0, 0}, {INFINITY, 0, 0}, {0, 1, 0}});
    for (const uint depth : {3u, 6u}) {
        check("nothing", {}, depth);
        check("a point", {{vec3(3.7f, 1e5f, -2), vec3(3.7f, 1e5f, -2), vec3(3.7f, 1e5f, -2)}}, depth);
        check("a segment", {{vec3(0), vec3(1, 2, 3), vec3(0.5f, 1, 1.5f)}}, depth);
        check("many times the same", same_one, depth);
        check("a floor and dust", huge, depth);
        check("needles", needles, depth);
        check("in faces of cells", walls, depth);
        check("not finite", broken, depth);
        check("scaled 1e-6", soup(100, 0.1f, 1e-6f), depth);
        check("scaled 1e6", soup(100, 0.1f, 1e6f), depth);
        check("scaled 1e-18", soup(30, 0.1f, 1e-18f), depth);
        check("far from the origin", soup(100, 0.3f, 1, vec3(1e6f, -1e6f, 1e6f)), depth);
        if (HasFailure()) return;
    }
}

TEST_F(SvoTest, sizes_around_a_workgroup) {
    for (const size_t n : {0, 1, 2, 63, 64, 65, 1025}) check((std::to_string(n) + " triangles").c_str(), soup(n, 0.01f), 5);
}

// The middle of what is there, not of the cell: of a wall's leaf in the wall, of a small triangle in it.
TEST_F(SvoTest, middles_are_on_the_surface) {
    const vec3 n = glm::normalize(vec3(0.3f, -0.8f, 0.4f)), across = glm::normalize(glm::cross(n, vec3(1, 0, 0))), down = glm::cross(n, across);
    const std::vector<Corners> wall = {{-3.0f * across - 2.0f * down, 3.0f * across - 2.0f * down, 4.0f * down}};
    const uint depth = 7;
    const SvoInput input = input_of(wall, depth);
    const SvoArrays svo = svo_download(device, build(input));
    const float side = 1 / input.cube.cells_per_length;
    for (uint block = 0; block < svo.blocks.size(); ++block)
        for (uint i = 0; i < svo_children(svo.blocks[block]); ++i) {
            const Sphere s = svo.sphere(block, i);
            ASSERT_LT(std::abs(glm::dot(s.center, n)), 2e-3f * s.radius);
            if (svo_height(svo.blocks[block]) == 0) { ASSERT_LT(s.radius, 0.95f * side); }
            ASSERT_GT(bsh_cone_cos_sin(svo.cones[svo.blocks[block].first + i]).x, 0.9999f) << "a wall is flat";
        }
    const std::vector<Corners> two = {{{0, 0, 0}, {1e-4f, 0, 0}, {0, 1e-4f, 0}}, {{1, 1, 1}, {1, 1, 0.9999f}, {1, 0.9999f, 1}}};
    const SvoArrays small = svo_download(device, build(input_of(two, 6)));
    ASSERT_EQ(small.spheres.size(), 13u);  // two chains and the root
    for (uint block = 1; block < small.blocks.size(); ++block)
        if (svo_height(small.blocks[block]) == 0) { EXPECT_LT(small.sphere(block, 0).radius, 2e-4f); }
}

// A plane far larger than cells is split among many lists' items, and so on; and room that is too little is found out and made.
TEST_F(SvoTest, room_that_is_too_little_grows_and_changes_nothing) {
    const SvoInput input = input_of(soup(200, 0.3f), 6);
    const Svo ample = build(input);
    const SvoArrays expected = svo_download(device, ample);
    const SvoSize size = ample.size();
    const SvoRoom room = ample.room();
    for (const SvoRoom& little : {SvoRoom{200, 1, 1, 1}, SvoRoom{room.next, size.pairs - 1, room.nodes, room.inner}, SvoRoom{room.next, room.pairs, size.nodes - 1, room.inner},
                                  SvoRoom{room.next, room.pairs, room.nodes, size.blocks() - 2}}) {
        const Svo svo = build(input, little);
        EXPECT_GT(svo.size().tries, 1u);
        EXPECT_LT(svo.size().tries, 12u);
        expect_equal(expected, svo_download(device, svo));
    }
    const Svo exact = build(input, {room.next, size.pairs, size.nodes, size.blocks() - 1});
    EXPECT_EQ(exact.size().tries, 1u);
    expect_equal(expected, svo_download(device, exact));
}

TEST_F(SvoTest, too_little_memory_has_a_cure) {
    const World world(soup(2000, 0.3f));
    engine::Device small({.select = "", .validation = true, .memory_limit = 8 << 20});
    Svo svo(small, world.view(), 10, vec3(-2), vec3(2));
    const auto positions = engine::upload(small, "test", "positions", world.positions);
    const auto triangles = engine::upload(small, "test", "triangles", world.triangles);
    engine::Recorder recorder(small);
    try {
        svo.build(recorder, positions, triangles);
        FAIL() << "that fitted";
    } catch (const OutOfMemory& e) {
        EXPECT_NE(std::string(e.what()).find("--tree svo:9"), std::string::npos) << e.what();
    }
}

// It is built anew of where triangles are.
TEST_F(SvoTest, follows_what_moves) {
    std::vector<Corners> before = soup(200, 0.1f), after = before;
    for (Corners& t : after)
        for (vec3* p : {&t.p0, &t.p1, &t.p2}) *p = vec3(p->y, 0.5f * p->z, p->x * p->x - 0.5f);
    const World world(before);
    Svo svo(device, world.view(), 6, vec3(-1.2f), vec3(1.2f));
    const auto triangles = on_device(world.triangles);
    engine::Recorder recorder(device);
    for (const auto& now : {before, after, before}) {
        svo.build(recorder, on_device(World(now).positions), triangles);
        const SvoInput input{now, svo.cube(), 6};
        const SvoArrays found = svo_download(device, svo);
        EXPECT_EQ(svo_check(found, input), "");
        expect_equal(svo_ref(input), found);
        svo.settle();
    }
}

TEST_F(SvoTest, keeps_what_is_missing) {
    const OpacityScene scene = OpacityScene::soup(200, 0.3f, random);
    const DeviceOpacity opacity(device, scene);
    std::vector<Corners> corners;
    scene.world().for_each([&](uint32_t, uint32_t, const Corners& c) { corners.push_back(c); });
    SvoInput input = input_of(corners, 5);
    input.opacity = scene.opacity();
    Svo svo(device, scene.world(), 5, input.cube.origin, input.cube.origin + 32.0f / input.cube.cells_per_length);
    input.cube = svo.cube();
    engine::Recorder recorder(device);
    svo.build(recorder, on_device(scene.positions), on_device(scene.triangles), nullptr, opacity.reader());
    SvoArrays found = svo_download(device, svo);
    EXPECT_EQ(svo_check(found, input), "");
    expect_equal(svo_ref(input), found);
    std::array<uint, 16> count{};
    for (const uvec2& box : found.boxes) ++count[bsh_missing(box)];
    EXPECT_GT(count[0], 100u);
    EXPECT_GT(count[opacity_nothing], 10u);
    found.boxes[found.boxes.size() / 2].y ^= 1u << 30;
    EXPECT_NE(svo_check(found, input), "");
}

TEST_F(SvoTest, instances_that_share_triangles) {
    const std::vector<Corners> stored = {{{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0.1f}}, {{0.1f, 0, 0}, {0.1f, 0.2f, 0}, {0, 0, 0.4f}}};
    const World world(stored);
    std::vector<Corners> all;
    WorldTriangles shared = world.view();
    for (int i = 0; i < 5; ++i) {
        shared.instances.push_back({.x = {1, 0.1f * float(i), 0}, .y = {0, 1, 0}, .z = {0.2f, 0, i == 3 ? -1.0f : 1.0f}, .at = vec3(0.3f * float(i)),
                                    .first_id = uint(all.size()), .first_triangle = 0, .count = 2, .flags = i == 3 ? instance_mirrored : 0});
        for (const Corners& c : stored) all.push_back(instance_corners(shared.instances.back(), c));
    }
    Svo svo(device, shared, 6, vec3(-1), vec3(3));
    const auto instances = on_device(shared.instances);
    engine::Recorder recorder(device);
    svo.build(recorder, on_device(world.positions), on_device(world.triangles), &instances);
    const SvoInput input{all, svo.cube(), 6};
    EXPECT_EQ(svo_check(svo_download(device, svo), input), "");
    expect_equal(svo_ref(input), svo_download(device, svo));
}

// Each kind of damage is reported.
TEST_F(SvoTest, the_check_finds_what_is_wrong) {
    const SvoInput input = input_of(soup(100, 0.1f), 5);
    const SvoArrays good = svo_download(device, build(input));
    ASSERT_EQ(svo_check(good, input), "");
    const auto fault_after = [&](auto damage) {
        SvoArrays svo = good;
        damage(svo);
        return svo_check(svo, input);
    };
    const uint inner = uint(good.blocks.size()) - 1, nodes = uint(good.spheres.size());
    for (const uint node : {0u, 3u, inner / 2, inner + 1, nodes - 1}) {
        EXPECT_NE(fault_after([&](SvoArrays& s) { s.spheres[node].y = (s.spheres[node].y & 0xffffu) | (s.spheres[node].y >> 16) * 3 / 4 << 16; }), "") << node;
        EXPECT_NE(fault_after([&](SvoArrays& s) { s.boxes[node].y = 0; }), "") << node;
    }
    uint narrow = 0;
    for (const uint node : {1u, inner / 2, inner + 1, nodes - 1})
        narrow += fault_after([&](SvoArrays& s) { s.cones[node] = (s.cones[node] & 0xffffffu) ^ 0x3ffu; }) != "";
    EXPECT_EQ(narrow, 4u);
    EXPECT_NE(fault_after([&](SvoArrays& s) { s.blocks[3].bits += 1; }), "");
    EXPECT_NE(fault_after([&](SvoArrays& s) { s.blocks[3].bits -= 16; }), "");
    EXPECT_NE(fault_after([&](SvoArrays& s) { s.blocks[3].first += 1; }), "");
    EXPECT_NE(fault_after([&](SvoArrays& s) { s.blocks.pop_back(); }), "");
}

}  // namespace
}  // namespace myriad::compute
