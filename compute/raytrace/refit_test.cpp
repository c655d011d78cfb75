// Trees that follow triangles that move.
#include "compute/raytrace/raytrace_testing.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {
namespace {

class RefitTest : public RaytraceTest {
protected:
    static WorldTriangles moving(const Mesh& m, uint first_moving) {
        WorldTriangles world = m.world();
        world.first_moving = first_moving;
        return world;
    }
    void refit(Bvh& bvh, const std::vector<vec3>& positions, const std::vector<uvec4>& triangles) {
        const auto on_device = engine::upload(device, "test", "positions", positions);
        const auto corners = engine::upload(device, "test", "triangles", triangles);
        engine::Recorder recorder(device);
        bvh.refit(recorder, on_device, corners);
        recorder.submit_and_wait();
    }
    BvhData downloaded(const Bvh& bvh, const BvhData& built) {
        BvhData tree = built;
        tree.nodes = engine::download(device, bvh.node_array());
        tree.triangles = engine::download(device, bvh.triangle_array());
        return tree;
    }
    static ::testing::AssertionResult same(const BvhData& a, const BvhData& b) {
        if (a.nodes.size() != b.nodes.size() || a.triangles.size() != b.triangles.size()) return ::testing::AssertionFailure() << "other sizes";
        for (size_t i = 0; i < a.triangles.size(); ++i)
            if (std::memcmp(&a.triangles[i], &b.triangles[i], sizeof(BvhTriangle)) != 0) return ::testing::AssertionFailure() << "triangle " << i;
        for (size_t i = 0; i < a.nodes.size(); ++i)
            if (std::memcmp(&a.nodes[i], &b.nodes[i], sizeof(BvhNode)) != 0) return ::testing::AssertionFailure() << "node " << i;
        return ::testing::AssertionSuccess();
    }

    // All that can happen to vertices from `first` on.
    std::vector<std::vector<vec3>> deformations(const Mesh& m, uint first) {
        std::vector<std::vector<vec3>> all;
        const auto deformed = [&](auto where) {
            std::vector<vec3> positions = m.positions;
            for (uint i = 3 * first; i < positions.size(); ++i) positions[i] = where(positions[i]);
            all.push_back(positions);
        };
        deformed([&](vec3 p) { return p + 0.02f * in_cube(); });
        deformed([&](vec3) { return 3.0f * in_cube(); });                                                    // torn to pieces
        deformed([](vec3 p) { return vec3(p.x * std::cos(2 * p.y) - p.z * std::sin(2 * p.y), p.y, p.x * std::sin(2 * p.y) + p.z * std::cos(2 * p.y)); });
        deformed([](vec3 p) { return vec3(p.x, 0, p.z); });                                                  // flat
        deformed([](vec3) { return vec3(0.25f, -0.5f, 1); });                                                // all in a point
        deformed([](vec3 p) { return 1e6f * p; });
        deformed([](vec3 p) { return p + vec3(1e6f, 0, -1e6f); });
        deformed([](vec3 p) { return 1e-6f * p; });
        deformed([&](vec3 p) { return random() % 2 ? p : 1e9f * glm::sign(p); });                             // to the end of the world
        deformed([](vec3 p) { return p; });                                                                  // and back
        return all;
    }
};

TEST_F(RefitTest, at_rest_changes_no_bit) {
    for (uint n : {1, 2, 4, 5, 33, 1000, 20000})
        for (uint first : {0u, n / 2, n - 1}) {
            const Mesh m = soup(n, 0.1f);
            const WorldTriangles world = moving(m, first);
            const BvhData built = build_bvh(world);
            Bvh bvh(device, world, built);
            EXPECT_GT(bvh.moving_nodes(), 0u);
            EXPECT_TRUE(first > 0 || bvh.moving_nodes() == built.nodes.size());
            refit(bvh, m.positions, m.triangles);
            EXPECT_TRUE(same(downloaded(bvh, built), built)) << n << " triangles, from " << first << " on";
        }
}

// Whatever happened to vertices: the twin's bits, everything within its boxes, and the hits that a tree built then has.
TEST_F(RefitTest, deformed_soups_equal_the_twin_and_brute_force) {
    for (const auto& [n, first] : {std::pair{3u, 0u}, {700u, 0u}, {700u, 400u}, {9000u, 8000u}}) {
        const Mesh m = soup(n, 0.15f);
        const WorldTriangles world = moving(m, first);
        const BvhData built = build_bvh(world);
        Bvh bvh(device, world, built);
        int kind = 0;
        for (const auto& positions : deformations(m, first)) {
            SCOPED_TRACE(::testing::Message() << n << " triangles, from " << first << " on, deformation " << kind++);
            refit(bvh, positions, m.triangles);
            const BvhData found = downloaded(bvh, built);
            EXPECT_TRUE(same(found, refit_ref(built, world, positions)));
            EXPECT_EQ(bvh_check(found), "");
            Mesh now{positions, m.triangles};
            agree(device, bvh, now.world(), random_rays(700));
        }
    }
}

// What was nothing at rest, and what was a copy of another, is there when it has moved.
TEST_F(RefitTest, nothing_that_moves_is_lost) {
    Mesh m = soup(300, 0.3f);
    const std::vector<vec3> unfolded = m.positions;
    for (const bool points : {false, true}) {
        for (size_t i = 0; i < m.positions.size(); ++i) m.positions[i] = points ? vec3(0.5f) : unfolded[i % 3];
        const WorldTriangles world = moving(m, 0);
        const BvhData built = build_bvh(world);
        ASSERT_EQ(built.dropped, 0u);
        EXPECT_LE(built.depth, bvh_max_depth);
        Bvh bvh(device, world, built);
        agree(device, bvh, m.world(), random_rays(500));
        refit(bvh, unfolded, m.triangles);
        EXPECT_EQ(bvh_check(downloaded(bvh, built)), "");
        agree(device, bvh, Mesh{unfolded, m.triangles}.world(), random_rays(1000));
    }
    // What stands still is treated as ever.
    EXPECT_GT(build_bvh(moving(m, 200)).dropped, 150u);
    EXPECT_EQ(build_bvh(moving(m, 200)).triangles.size(), build_bvh(moving(m, 300)).triangles.size() + 100);
}

TEST_F(RefitTest, nothing_to_do_where_nothing_moves) {
    const Mesh m = soup(100, 0.2f), none;
    for (const Mesh* mesh : {&m, &none})
        for (uint first : {uint(mesh->triangles.size()), ~0u}) {
            const BvhData built = build_bvh(moving(*mesh, first));
            Bvh bvh(device, moving(*mesh, first), built);
            EXPECT_EQ(bvh.moving_nodes(), 0u);
            refit(bvh, mesh->positions, mesh->triangles);
            EXPECT_TRUE(same(downloaded(bvh, built), built));
        }
}

// Only nodes above what moves are visited, and no other changes.
TEST_F(RefitTest, what_stands_still_stays) {
    Mesh m;
    for (uint i = 0; i < 4000; ++i) m.triangle(in_cube() - vec3(5, 0, 0), in_cube() - vec3(5, 0, 0), in_cube() - vec3(5, 0, 0));
    for (uint i = 0; i < 40; ++i) m.triangle(in_cube() + vec3(5, 0, 0), in_cube() + vec3(5, 0, 0), in_cube() + vec3(5, 0, 0));
    const WorldTriangles world = moving(m, 4000);
    const BvhData built = build_bvh(world);
    Bvh bvh(device, world, built);
    EXPECT_LT(bvh.moving_nodes(), 60u);
    for (size_t i = 12000; i < m.positions.size(); ++i) m.positions[i] *= 2.0f;
    refit(bvh, m.positions, m.triangles);
    const BvhData found = downloaded(bvh, built);
    EXPECT_EQ(bvh_check(found), "");
    size_t changed = 0;
    for (size_t i = 0; i < found.nodes.size(); ++i) changed += std::memcmp(&found.nodes[i], &built.nodes[i], sizeof(BvhNode)) != 0;
    EXPECT_GT(changed, 1u);
    EXPECT_LE(changed, bvh.moving_nodes());
}

// Meshes that instances share stand still beside what moves.
TEST_F(RefitTest, instances_stand_beside_what_moves) {
    const Mesh shared = soup(500, 0.2f), creature = soup(200, 0.2f);
    Mesh stored = shared;
    for (const uvec4& t : creature.triangles) stored.triangles.push_back({t.x + shared.positions.size(), t.y + shared.positions.size(), t.z + shared.positions.size(), 0});
    stored.positions.insert(stored.positions.end(), creature.positions.begin(), creature.positions.end());
    WorldTriangles world = moving(stored, 500);
    for (uint k = 0; k < 3; ++k) {
        Instance i{};
        i.x = vec3(1, 0.1f, 0), i.y = vec3(0, 0.7f, 0), i.z = vec3(0.1f, 0, 1), i.at = vec3(float(k) - 1, 0.3f, 0);
        i.first_id = 500 * k, i.first_triangle = 0, i.count = 500;
        world.instances.push_back(i);
    }
    Instance all{};
    all.first_id = 1500, all.first_triangle = 500, all.count = 200, all.flags = instance_in_world;
    world.instances.push_back(all);
    const BvhData built = build_bvh(world);
    Bvh bvh(device, world, built);
    for (const float far : {0.0f, 0.5f, 4.0f}) {
        Mesh now, written;
        now = stored;
        for (size_t i = shared.positions.size(); i < now.positions.size(); ++i) now.positions[i] = now.positions[i] * (1 + far) + vec3(0, far, 0);
        WorldTriangles placed = now.world();
        placed.instances = world.instances;
        placed.for_each([&](uint, uint, const Corners& c) { written.triangle(c.p0, c.p1, c.p2); });
        refit(bvh, now.positions, now.triangles);
        EXPECT_EQ(bvh_check(downloaded(bvh, built)), "");
        std::vector<Ray> rays = random_rays(800);
        for (size_t i = 0; i < rays.size(); i += 2) rays[i].origin += vec3(0, far, 0);
        agree(device, bvh, written.world(), rays);
    }
}

TEST_F(RefitTest, the_checker_sees_what_is_outside) {
    const Mesh m = soup(2000, 0.1f);
    BvhData tree = build_bvh(moving(m, 0));
    ASSERT_EQ(bvh_check(tree), "");
    for (size_t k : {size_t(0), tree.triangles.size() / 2}) {
        BvhData wrong = tree;
        wrong.triangles[k].p1.x += 0.5f;
        EXPECT_NE(bvh_check(wrong), "") << "a triangle moved, its boxes did not";
    }
    BvhData lost = tree, twice = tree, shallow = tree, empty = tree;
    lost.nodes.push_back({});
    EXPECT_NE(bvh_check(lost), "");
    empty.nodes[0].child[0] = {};
    EXPECT_NE(bvh_check(empty), "");
    shallow.depth -= 1;
    EXPECT_NE(bvh_check(shallow), "");
    const auto leaf = [](const BvhNode& node, uint i) { return bvh_children(node.frame) > i && node.child[i].x >> 24 > 0; };
    const auto two = std::ranges::find_if(twice.nodes, [&](const BvhNode& node) { return leaf(node, 0) && leaf(node, 1); });
    ASSERT_NE(two, twice.nodes.end());
    two->child[1] = two->child[0];
    EXPECT_NE(bvh_check(twice).find("leaves"), std::string::npos) << "the second child's triangles are in none, the first's in two";
}

}  // namespace
}  // namespace myriad::compute
