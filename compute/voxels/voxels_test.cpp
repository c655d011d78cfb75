#include "compute/voxels/voxels.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "compute/octree/octree_ref.hpp"
#include "compute/voxels/voxels_ref.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {

static void PrintTo(const Voxel& v, std::ostream* out) { *out << "triangle " << v.triangle << " in cell " << std::oct << v.key << std::dec; }

namespace {

using engine::same;

class VoxelsTest : public engine::DeviceTest {
protected:
    float uniform(float low, float high) { return low + (high - low) * float(random()) * 0x1p-32f; }
    vec3 point(float low, float high) { return {uniform(low, high), uniform(low, high), uniform(low, high)}; }
    const vec3 origin{-3, 5, 0.1f};
    OctreeCube cube(uint depth) const { return octree_cube(origin, origin + vec3(2, 1, 2), depth); }

    // Of every kind, in a cube of side 2 at the origin above.
    std::vector<Corners> triangles(uint depth) {
        std::vector<Corners> all;
        const float cell = 2.0f / float(1u << depth);
        const auto add = [&](vec3 a, vec3 b, vec3 c) { all.push_back({origin + a, origin + b, origin + c}); };
        for (int i = 0; i < 12; ++i) add(point(0, 2), point(0, 2), point(0, 2));
        for (int i = 0; i < 12; ++i) {  // small
            const vec3 at = point(0, 2);
            add(at, at + point(-cell, cell), at + point(-cell, cell));
        }
        for (const float width : {1e-2f, 1e-4f, 1e-6f, 0.0f}) {  // needles
            const vec3 a = point(0, 2), b = point(0, 2);
            add(a, b, mix(a, b, 0.3f) + width * point(-1, 1));
            add(a, b, b + width * point(-1, 1));
            add({a.x, a.y, 0.5f}, {b.x, a.y, 0.5f}, {b.x, a.y + width, 0.5f});
        }
        const vec3 at = point(0, 2);
        add(at, at, at);
        add(vec3(cell), vec3(cell), vec3(cell));               // a corner of eight cells
        add(vec3(0), vec3(2), vec3(2));                        // the cube's diagonal
        for (int axis = 0; axis < 3; ++axis)
            for (const float where : {0.0f, cell, 1.0f, 2.0f - cell, 2.0f, 0.77f}) {  // in a face of cells
                vec3 a = point(0, 2), b = point(0, 2), c = point(0, 2);
                a[axis] = b[axis] = c[axis] = where;
                add(a, b, c);
            }
        add({-100, -90, 0.3f}, {120, -80, 1.1f}, {3, 150, 0.7f});  // far out of the cube
        add({-1e6f, -1e6f, -1e6f}, {1e6f, 0, 0}, {0, 1e6f, 1e6f});
        add({5, 5, 5}, {6, 5, 5}, {5, 6, 5});                  // outside
        add({1, 1, NAN}, {0.5f, 1, 1}, {1, 0.5f, 1});          // nowhere
        add({INFINITY, 1, 1}, {0.5f, 1, 1}, {1, 0.5f, 1});
        add({-INFINITY, 1, 1}, {INFINITY, 1, 1}, {1, NAN, 1});
        return all;
    }
    static std::vector<Voxel> sorted(std::vector<Voxel> voxels) {
        std::sort(voxels.begin(), voxels.end());
        return voxels;
    }

    struct World {
        engine::Array<vec3> positions;
        engine::Array<uvec4> triangles;
        engine::Array<Instance> instances;
        engine::Array<uint> count;
        VoxelTriangles view() const {
            return {positions, triangles, instances.count() ? &instances : nullptr, uint32_t(instances.count())};
        }
    };
    World world(const std::vector<Corners>& corners) {
        std::vector<vec3> positions;
        std::vector<uvec4> indices;
        for (const Corners& c : corners) {
            const uint first = uint(positions.size());
            positions.insert(positions.end(), {c.p0, c.p1, c.p2});
            indices.emplace_back(first, first + 1, first + 2, 0);
        }
        return {on_device(positions), on_device(indices), {}, on_device(std::vector<uint>{uint(corners.size())})};
    }
    std::unique_ptr<Voxels> run(const World& world, AppendMode mode, uint depth, uint64_t next, uint64_t kept, uint first = 0, std::optional<uint> limit = {}) {
        auto voxels = std::make_unique<Voxels>(device, mode, depth, next, kept, engine::Constants{{instanced_constant, world.instances.count() > 0}});
        engine::Recorder recorder(device);
        voxels->record(recorder, world.view(), world.count, first, limit.value_or(uint(next)), cube(depth));
        recorder.submit_and_wait();
        return voxels;
    }
    std::vector<Voxel> fetched(const Voxels& voxels) {
        std::vector<Voxel> out;
        for (const uvec2 pair : engine::download(device, voxels.lists().kept(), voxels.lists().report().kept)) {
            const uvec2 key = voxel_key(pair);
            out.push_back({uint64_t(key.y) << 32 | key.x, voxel_triangle_of(pair)});
        }
        return out;
    }
};

TEST_F(VoxelsTest, clipping_knows_plain_cases) {
    const OctreeCube unit = octree_cube({0, 0, 0}, {4, 4, 4}, 2);
    const Corners t{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}};
    EXPECT_TRUE(meets_cell(t, unit, {1, 1, 0}, 0));
    EXPECT_TRUE(meets_cell(t, unit, {0, 0, 0}, 0));  // touches the edge
    EXPECT_FALSE(meets_cell(t, unit, {0, 0, 0}, -1e-6));
    EXPECT_FALSE(meets_cell(t, unit, {1, 1, 1}, 0));
    EXPECT_TRUE(meets_cell(t, unit, {1, 1, 1}, 1.1));
    EXPECT_FALSE(meets_cell({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, unit, {3, 3, 0}, 0));  // its box would
}

// No cell that a triangle surely meets is missed, at any level, and none is named that it is not very near to. Brute force over all cells.
TEST_F(VoxelsTest, misses_nothing_and_invents_nothing) {
    for (uint depth = 1; depth <= 5; ++depth) {
        const auto all = triangles(depth);
        const auto found = sorted(voxels_ref(all, cube(depth), depth));
        const uint cells = 1u << depth;
        size_t missed = 0, invented = 0, met = 0;
        for (uint i = 0; i < all.size(); ++i) {
            if (!std::isfinite(all[i].p0.x + all[i].p0.z + all[i].p1.x + all[i].p2.y)) {
                EXPECT_EQ(std::ranges::count(found, i, &Voxel::triangle), 0);
                continue;
            }
            const VoxelTriangle t = voxel_triangle(all[i], cube(depth), depth);
            const double reach = 8 * double(t.margin);
            for (uint64_t key = 0; key < uint64_t(cells) * cells * cells; ++key) {
                const uvec3 cell = octree_cell_of({uint(key), 0});
                const bool named = std::binary_search(found.begin(), found.end(), Voxel{key, i});
                if (meets_cell(all[i], cube(depth), cell, 0)) ++met, missed += !named;
                else if (named) invented += !meets_cell(all[i], cube(depth), cell, reach);
            }
        }
        EXPECT_GT(met, 50u);
        EXPECT_EQ(missed, 0u) << "depth " << depth << ", of " << met;
        EXPECT_EQ(invented, 0u) << "depth " << depth << ", beside " << met;
    }
}

TEST_F(VoxelsTest, equals_the_recursion) {
    for (const uint depth : {1u, 2u, 5u, 7u}) {
        const auto all = triangles(depth);
        const auto expected = voxels_ref(all, cube(depth), depth);
        const World w = world(all);
        const auto ordered = run(w, AppendMode::scan, depth, expected.size() + all.size(), expected.size());
        ASSERT_TRUE(ordered->lists().report().ok());
        EXPECT_TRUE(same(expected, fetched(*ordered))) << "depth " << depth;  // triangle by triangle, in Morton order
        const auto atomic = run(w, AppendMode::atomic, depth, expected.size() + all.size(), expected.size());
        ASSERT_TRUE(atomic->lists().report().ok());
        EXPECT_TRUE(same(sorted(expected), sorted(fetched(*atomic)))) << "depth " << depth;
    }
}

TEST_F(VoxelsTest, few_triangles_many_triangles_and_a_part_of_them) {
    for (const size_t n : {0, 1, 2, 63, 64, 65, 1025}) {
        std::vector<Corners> all;
        for (size_t i = 0; i < n; ++i) {
            const vec3 at = origin + point(0, 2);
            all.push_back({at, at + point(-0.05f, 0.05f), at + point(-0.05f, 0.05f)});
        }
        const auto expected = voxels_ref(all, cube(6), 6);
        const World w = world(all);
        const auto voxels = run(w, AppendMode::scan, 6, expected.size() + n, expected.size());
        EXPECT_TRUE(same(expected, fetched(*voxels))) << n << " triangles";
        if (n < 60) continue;
        std::vector<Voxel> some;
        for (const Voxel& v : expected)
            if (v.triangle >= 10 && v.triangle < 50) some.push_back(v);
        EXPECT_TRUE(same(some, fetched(*run(w, AppendMode::scan, 6, expected.size(), expected.size(), 10, 40))));
    }
}

TEST_F(VoxelsTest, as_deep_as_it_goes) {
    std::vector<Corners> all;
    for (int i = 0; i < 20; ++i) {
        const vec3 at = origin + point(1.98f, 2);  // the highest bits of keys are set
        all.push_back({at, at + point(-0.002f, 0.002f), at + point(-0.002f, 0.002f)});
    }
    const auto expected = voxels_ref(all, cube(voxels_max_depth), voxels_max_depth);
    const World w = world(all);
    const auto voxels = run(w, AppendMode::scan, voxels_max_depth, expected.size() + 20, expected.size());
    EXPECT_TRUE(same(expected, fetched(*voxels)));
}

TEST_F(VoxelsTest, over_capacity_is_said_and_longer_lists_do) {
    const auto all = triangles(5);
    const auto expected = voxels_ref(all, cube(5), 5);
    const World w = world(all);
    for (const AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        uint64_t next = all.size(), kept = 1;
        for (int redone = 0;; ++redone) {
            ASSERT_LT(redone, 10);
            const auto voxels = run(w, mode, 5, next, kept, 0, uint(all.size()));
            const AppendReport report = voxels->lists().report();
            if (report.ok()) {
                EXPECT_GT(redone, 1);
                EXPECT_TRUE(same(sorted(expected), sorted(fetched(*voxels))));
                break;
            }
            next = std::max(next, report.next_needed), kept = std::max(kept, report.kept_needed);
        }
    }
}

TEST_F(VoxelsTest, instances_that_share_triangles) {
    const std::vector<Corners> stored = {{{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0.1f}}, {{0.1f, 0, 0}, {0.1f, 0.2f, 0}, {0, 0, 0.4f}}};
    World w = world(stored);
    std::vector<Instance> instances;
    std::vector<Corners> all;
    for (int i = 0; i < 5; ++i) {
        Instance instance{.x = {1, 0.1f * float(i), 0}, .y = {0, 1, 0}, .z = {0.2f, 0, i == 3 ? -1.0f : 1.0f}, .at = origin + vec3(0.3f * float(i)),
                          .first_id = uint(all.size()), .first_triangle = 0, .count = 2, .flags = i == 3 ? instance_mirrored : 0};
        instances.push_back(instance);
        for (const Corners& c : stored) all.push_back(instance_corners(instance, c));
    }
    w.instances = on_device(instances);
    w.count = on_device(std::vector<uint>{uint(all.size())});
    const auto expected = voxels_ref(all, cube(6), 6);
    EXPECT_TRUE(same(expected, fetched(*run(w, AppendMode::scan, 6, expected.size(), expected.size()))));
}

// An octree over the pairs: its leaves are the cells that any triangle meets.
TEST_F(VoxelsTest, become_an_octree) {
    const auto all = triangles(6);
    auto expected = voxels_ref(all, cube(6), 6);
    const World w = world(all);
    Voxels voxels(device, AppendMode::scan, 6, expected.size(), expected.size(), engine::Constants{{instanced_constant, 0}});
    std::vector<uint64_t> keys;
    for (const Voxel& v : expected) keys.push_back(v.key);
    const OctreeTwin twin = octree_ref(keys, 6);
    Octree octree(device, expected.size(), twin.nodes(), 6);
    engine::Recorder recorder(device);
    voxels.record(recorder, w.view(), w.count, 0, uint(all.size()), cube(6));
    voxels.record_items(recorder, octree);
    octree.record(recorder, voxels.lists().state(), AppendLists::kept_word);
    octree.end(recorder);
    recorder.submit_and_wait();
    ASSERT_TRUE(voxels.lists().report().ok());
    ASSERT_TRUE(octree.report().ok());
    EXPECT_EQ(octree.report().needed(), twin.nodes());
    EXPECT_TRUE(same(twin.first, engine::download(device, octree.first())));
    std::vector<uint> items;
    for (const uint at : twin.items) items.push_back(expected[at].triangle);
    EXPECT_TRUE(same(items, engine::download(device, octree.sorted_items())));
}

TEST_F(VoxelsTest, comparator_sees_one_wrong_voxel) {
    const auto good = voxels_ref(triangles(3), cube(3), 3);
    auto wrong = good;
    wrong[7].key ^= 1;
    EXPECT_FALSE(same(good, wrong));
    wrong = good;
    wrong.pop_back();
    EXPECT_FALSE(same(good, wrong));
}

}  // namespace
}  // namespace myriad::compute
