#include "compute/bsh/bsh.hpp"

#include <functional>

#include "compute/bsh/bsh_order.hpp"
#include "compute/bsh/bsh_ref.hpp"
#include "compute/opacity/opacity_testing.hpp"
#include "compute/surface_sampling/surface_sampling.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {
namespace {

using engine::same;
using glm::uvec4, glm::vec3;

struct Mesh {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;

    void add(vec3 a, vec3 b, vec3 c) {
        const uint first = uint(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2, 0});
    }
};

// The hard cases of spec, section 4, that a tree can meet.
struct Case {
    std::string name;
    Mesh mesh;
};
std::vector<Case> cases(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    auto point = [&](float scale = 1, vec3 origin = vec3(0)) { return origin + scale * vec3(unit(random), unit(random), unit(random)); };
    auto soup = [&](int n, std::function<vec3()> corner) {
        Mesh mesh;
        for (int i = 0; i < n; ++i) mesh.add(corner(), corner(), corner());
        return mesh;
    };
    std::vector<Case> all;
    all.push_back({"random", soup(300, [&] { return point(); })});
    all.push_back({"one triangle", soup(1, [&] { return point(); })});
    all.push_back({"planar", soup(100, [&] { return vec3(unit(random), unit(random), 0.25f); })});
    all.push_back({"oblique plane", soup(100, [&] { const vec3 p = point(); return vec3(p.x, p.y, 0.3f * p.x - 0.7f * p.y); })});
    all.push_back({"collinear", soup(20, [&] { return unit(random) * vec3(1, 0, 0); })});
    all.push_back({"oblique line", soup(20, [&] { return unit(random) * vec3(0.3f, -0.7f, 1.1f); })});
    all.push_back({"coincident", soup(5, [&] { return vec3(0.1f, -7.3f, 1e3f); })});
    all.push_back({"scaled 1e-6", soup(100, [&] { return point(1e-6f); })});
    all.push_back({"scaled 1e6", soup(100, [&] { return point(1e6f); })});
    all.push_back({"scaled 1e18", soup(50, [&] { return point(1e18f); })});
    all.push_back({"scaled 1e-18", soup(50, [&] { return point(1e-18f); })});
    all.push_back({"1e6 off the origin", soup(100, [&] { return point(1, vec3(1e6f, -1e6f, 1e6f)); })});
    Mesh clusters = soup(4, [&] { return point(1e3f); });
    for (int i = 0; i < 100; ++i) {
        const vec3 p = point(1e3f);
        clusters.add(p + point(1e-3f), p + point(1e-3f), p + point(1e-3f));
    }
    all.push_back({"clusters 1:1e6", clusters});
    Mesh needles;
    for (int i = 0; i < 100; ++i) {
        const vec3 a = point(), b = point();
        needles.add(a, b, 0.5f * (a + b) + point(1e-5f));
    }
    all.push_back({"needles", needles});
    Mesh sheet;  // two faces of one sheet, wound in opposite ways
    for (int i = 0; i < 10; ++i) {
        const vec3 a(point().x, point().y, 0), b(point().x, point().y, 0), c(point().x, point().y, 0);
        sheet.add(a, b, c);
        sheet.add(a + vec3(0, 0, 1e-3f), c + vec3(0, 0, 1e-3f), b + vec3(0, 0, 1e-3f));
    }
    all.push_back({"two-sided sheet", sheet});
    return all;
}

class BshTest : public engine::DeviceTest {
protected:
    struct Built {
        Bsh bsh;
        BshArrays tree;
        std::vector<SurfaceSample> samples;
    };
    Built build(const Mesh& mesh, uint32_t depth, uint32_t seed = 1) {
        Built built{Bsh(device, {mesh.positions, mesh.triangles}, depth, seed), {}, {}};
        refit(built, mesh);
        built.samples = engine::download(device, built.bsh.samples());
        return built;
    }
    void refit(Built& built, const Mesh& mesh) {
        auto positions = on_device(mesh.positions);
        auto triangles = on_device(mesh.triangles);
        engine::Recorder recorder(device);
        built.bsh.refit(recorder, positions, triangles);
        recorder.submit_and_wait();
        built.tree = bsh_download(device, built.bsh);
    }
    static BshInput input(const Built& built, const Mesh& mesh) {
        return {built.samples, mesh.positions, mesh.triangles, built.bsh.sample_radius(), built.bsh.sample_share()};
    }
    static void expect_equal(const BshArrays& twin, const BshArrays& tree) {
        EXPECT_TRUE(same(twin.frames, tree.frames));
        EXPECT_TRUE(same(twin.spheres, tree.spheres));
        EXPECT_TRUE(same(twin.cones, tree.cones));
        for (size_t i = 0; i < tree.boxes.size(); ++i) ASSERT_EQ(bsh_missing(twin.boxes[i]), bsh_missing(tree.boxes[i])) << i;
    }
};

TEST_F(BshTest, device_equals_twin_and_both_are_valid) {
    for (const Case& c : cases(random))
        for (uint32_t depth : {0, 1, 2, 3, 4, 5, 6, 9, 10, 13}) {
            SCOPED_TRACE(c.name + ", d = " + std::to_string(depth));
            const Built built = build(c.mesh, depth);
            ASSERT_EQ(built.bsh.leaves(), 1u << depth);
            const BshArrays twin = bsh_ref(input(built, c.mesh));
            EXPECT_EQ(bsh_check(twin, input(built, c.mesh)), "") << "(twin)";
            EXPECT_EQ(bsh_check(built.tree, input(built, c.mesh)), "") << "(device)";
            expect_equal(twin, built.tree);
            if (HasFailure()) return;
        }
}

// Cut-outs are whole where samples stand; blended surfaces are not, and nodes are as whole as the most whole child.
TEST_F(BshTest, keeps_what_is_missing_of_blended_surfaces) {
    const OpacityScene scene = OpacityScene::soup(200, 0.3f, random);
    const DeviceOpacity opacity(device, scene);
    Bsh bsh(device, scene.world(), 11, 1);
    const auto positions = on_device(scene.positions);
    const auto triangles = on_device(scene.triangles);
    engine::Recorder recorder(device);
    bsh.refit(recorder, positions, triangles, nullptr, opacity.reader());
    recorder.submit_and_wait();
    const auto samples = engine::download(device, bsh.samples());
    BshArrays tree = bsh_download(device, bsh);
    const BshInput input{samples, scene.positions, scene.triangles, bsh.sample_radius(), bsh.sample_share(), scene.opacity()};
    EXPECT_EQ(bsh_check(tree, input), "");
    expect_equal(bsh_ref(input), tree);
    std::array<uint, 16> count{};
    for (uint leaf = 0; leaf < tree.leaves; ++leaf) ++count[bsh_missing(tree.boxes[leaf])];
    EXPECT_EQ(count[opacity_nothing], 0u);
    EXPECT_GT(count[0], 500u);
    EXPECT_GT(std::count_if(count.begin() + 1, count.end(), [](uint n) { return n > 0; }), 8);
    tree.boxes[tree.leaves + 3].y ^= 1u << 30;
    EXPECT_NE(bsh_check(tree, input), "");
}

TEST_F(BshTest, follows_deformation) {
    Mesh mesh = cases(random)[0].mesh;
    Built built = build(mesh, 9);
    for (vec3& p : mesh.positions) p = vec3(p.y * 3 + p.x * p.x, p.z - p.x, 2.0f * p.x + 5.0f);
    EXPECT_NE(bsh_check(built.tree, input(built, mesh)), "") << "bounds of the old positions cannot hold";
    refit(built, mesh);
    EXPECT_EQ(bsh_check(built.tree, input(built, mesh)), "");
    expect_equal(bsh_ref(input(built, mesh)), built.tree);
}

TEST_F(BshTest, empty_scene) {
    Bsh bsh(device, {}, 10, 1);
    EXPECT_TRUE(bsh.empty());
    EXPECT_EQ(bsh.leaves() + bsh.blocks() + bsh.slots() + bsh.levels() + bsh.bytes(), 0u);
    auto positions = on_device(std::vector<vec3>{});
    auto triangles = on_device(std::vector<uvec4>{});
    engine::Recorder recorder(device);
    bsh.refit(recorder, positions, triangles);
    recorder.submit_and_wait();
}

TEST_F(BshTest, sizes) {
    const Mesh mesh = cases(random)[0].mesh;
    const struct { uint32_t depth; uint blocks, levels; } expected[] = {{0, 1, 1}, {1, 1, 1}, {3, 1, 1}, {4, 3, 2},
                                                                        {6, 9, 2}, {7, 19, 3}, {9, 73, 3}};
    for (const auto& e : expected) {
        const Bsh bsh(device, {mesh.positions, mesh.triangles}, e.depth, 1);
        EXPECT_EQ(bsh.blocks(), e.blocks) << e.depth;
        EXPECT_EQ(bsh.levels(), e.levels) << e.depth;
        EXPECT_EQ(bsh.root(), 8 * e.blocks) << e.depth;
    }
}

TEST_F(BshTest, coincident_samples_have_radius_zero) {
    Mesh mesh;
    mesh.add(vec3(3.7f, 1e5f, -2), vec3(3.7f, 1e5f, -2), vec3(3.7f, 1e5f, -2));
    const Built built = build(mesh, 7);
    EXPECT_EQ(built.tree.sphere(built.tree.root()).radius, 0.0f);
    EXPECT_EQ(built.tree.sphere(built.tree.root()).center, vec3(3.7f, 1e5f, -2));
}

TEST_F(BshTest, two_sided_sheet_is_flat) {
    const Mesh sheet = cases(random).back().mesh;
    const Built built = build(sheet, 10);
    EXPECT_GT(bsh_cone_cos_sin(built.tree.cones[built.tree.root()]).x, 0.99f);
}

// Each kind of damage is reported, in every level.
TEST_F(BshTest, validator_reports_damage) {
    const Mesh mesh = cases(random)[0].mesh;
    const Built built = build(mesh, 10);
    auto fault_after = [&](auto damage) {
        BshArrays tree = built.tree;
        damage(tree);
        return bsh_check(tree, input(built, mesh));
    };
    ASSERT_EQ(bsh_check(built.tree, input(built, mesh)), "");
    for (const BshLevel& level : bsh_levels(1024, 8)) {
        const uint slot = level.first_slot + level.nodes - 1;
        SCOPED_TRACE(slot);
        EXPECT_NE(fault_after([&](BshArrays& t) { t.spheres[slot].y -= 4u << 16; }), "") << "a smaller radius";
        EXPECT_NE(fault_after([&](BshArrays& t) { t.spheres[slot].x ^= 0x8000; t.frames[slot / 8].w += 1; }), "") << "a moved centre";
        EXPECT_NE(fault_after([&](BshArrays& t) { t.spheres[slot].y = bsh_absent << 16; }), "") << "a missing node";
        EXPECT_NE(fault_after([&](BshArrays& t) { t.cones[slot] &= 0xffffffu; t.cones[slot] ^= 0x400; }), "") << "a narrow cone";
        EXPECT_NE(fault_after([&](BshArrays& t) { t.frames[slot / 8].x += 1; }), "") << "a moved frame";
        EXPECT_NE(fault_after([&](BshArrays& t) { t.boxes[slot].y -= 200u << 10; }), "") << "a smaller box";
    }
    EXPECT_NE(fault_after([](BshArrays& t) { t.spheres[t.root() + 1] = t.spheres[t.root()]; }), "") << "a second root";
    EXPECT_NE(fault_after([](BshArrays& t) { t.blocks -= 1; }), "");
    EXPECT_NE(fault_after([](BshArrays& t) { t.leaves /= 2; }), "");
    Built swapped{Bsh(device, {}, 0, 1), {}, built.samples};
    std::swap(swapped.samples.front(), swapped.samples.back());
    EXPECT_NE(bsh_check(built.tree, {swapped.samples, mesh.positions, mesh.triangles, built.bsh.sample_radius(), built.bsh.sample_share()}), "") << "leaves in another order";
}

TEST(BshFormulaTest, radius_codes_round_up_tightly) {
    std::mt19937 random(3);
    for (int i = 0; i < 100000; ++i) {
        const float r = uintBitsToFloat(random() % 0x7f000000u);
        const uint code = bsh_radius_code(r);
        EXPECT_GE(uintBitsToFloat(code << 15), r);
        EXPECT_TRUE(code == 0 || uintBitsToFloat((code - 1) << 15) < r) << r;
        if (HasFailure()) return;
    }
    EXPECT_EQ(bsh_radius_code(0), 0u);
    EXPECT_LT(bsh_radius_code(3e38f), bsh_absent);
}

// Every axis that a code can name is found again, or one that is the same direction.
TEST(BshFormulaTest, axes_survive_packing) {
    float worst = 1;
    for (uint axis = 0; axis < 1u << 24; axis += 7) {
        if ((axis & 0xfff) == 0 || axis >> 12 == 0) continue;  // -2048: outside the map, never written
        const vec3 a = bsh_cone_axis(axis);
        worst = std::min(worst, dot(a, bsh_cone_axis(bsh_cone_pack_axis(a))));
    }
    EXPECT_GT(worst, 0.999999f);
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 100000; ++i) {
        const vec3 n = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        worst = std::min(worst, dot(n, bsh_cone_axis(bsh_cone_pack_axis(n))));
    }
    EXPECT_GT(worst, 1 - 1e-6f);  // 1.4e-3 rad
}

// Lines of the children's cones lie in the merged cone; judged in double, by sampling the children's rims.
TEST(BshFormulaTest, merged_cones_contain_their_children) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    for (int round = 0; round < 20000; ++round) {
        BshCones children;
        const vec3 around(normal(random), normal(random), normal(random));
        const float spread = std::exp(3 * normal(random) - 2);
        for (uint& cone : children.at)
            cone = bsh_cone_pack_axis((random() % 2 ? 1.0f : -1.0f) * around + spread * vec3(normal(random), normal(random), normal(random))) |
                   (random() % (round % 3 == 0 ? 256 : 16)) << 24;
        const uint merged = bsh_cone_merge(children);
        if (merged >> 24 == 255) continue;
        const double t = (merged >> 24) / 255.0, least = 1 - t * t;
        const glm::dvec3 axis = glm::normalize(glm::dvec3(bsh_cone_axis(merged)));
        for (uint cone : children.at) {
            const glm::dvec3 a = glm::normalize(glm::dvec3(bsh_cone_axis(cone)));
            const glm::dvec3 side = glm::normalize(glm::cross(a, std::abs(a.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
            const glm::dvec3 up = glm::cross(a, side);
            const double s = (cone >> 24) / 255.0, c = 1 - s * s, radius = s * std::sqrt(2 - s * s);
            for (int i = 0; i < 12; ++i) {
                const glm::dvec3 rim = c * a + radius * (std::cos(i * 0.5236) * side + std::sin(i * 0.5236) * up);
                ASSERT_GE(std::abs(glm::dot(axis, rim)), least - 1e-12) << round;
            }
        }
    }
}

TEST(BshFormulaTest, merged_spheres_contain_their_children_and_are_small) {
    std::mt19937 random(12);
    std::normal_distribution<float> normal;
    for (int round = 0; round < 20000; ++round) {
        BshSpheres children;
        const float scale = std::exp(8 * normal(random));
        const vec3 at = vec3(normal(random), normal(random), normal(random)) * std::exp(8 * normal(random));
        for (Sphere& s : children.at) s = {at + scale * vec3(normal(random), normal(random), normal(random)), scale * std::abs(normal(random))};
        const Sphere merged = bsh_merge(children);
        glm::vec<3, long double> low(1e30L), high(-1e30L);
        for (const Sphere& s : children.at) {
            const glm::vec<3, long double> d = glm::vec<3, long double>(s.center) - glm::vec<3, long double>(merged.center);
            ASSERT_LE(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) + s.radius, (long double)merged.radius) << round;
            low = glm::min(low, glm::vec<3, long double>(s.center) - (long double)s.radius);
            high = glm::max(high, glm::vec<3, long double>(s.center) + (long double)s.radius);
        }
        const auto extent = high - low;  // the sphere around the children's box always does
        const long double half_diagonal = 0.5L * std::sqrt(extent.x * extent.x + extent.y * extent.y + extent.z * extent.z);
        ASSERT_LE(merged.radius, 1.0001L * half_diagonal + 1e-6L * glm::length(merged.center));
    }
}

TEST(BshOrderTest, permutation_of_medians_whatever_the_threads) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int kind = 0; kind < 4; ++kind)  // in space, in a plane, on a line, in one point
        for (size_t n : {1, 2, 8, 1024, 16384}) {
            std::vector<vec3> points(n);
            for (vec3& p : points) {
                p = vec3(unit(random), unit(random), unit(random));
                if (kind > 0) p.z = 1;
                if (kind > 1) p.y = p.x;
                if (kind > 2) p = vec3(0.5f);
            }
            const auto order = bsh_order(points, 1);
            EXPECT_EQ(bsh_check_order(order, points), "") << kind << " " << n;
            for (uint32_t threads : {2, 3, 8}) EXPECT_TRUE(same(order, bsh_order(points, threads))) << kind << " " << n;
            auto broken = order;
            if (n < 8) continue;
            broken[0] = broken[1];
            EXPECT_NE(bsh_check_order(broken, points), "");
            if (kind > 2) continue;
            broken = order;
            std::swap(broken[0], broken[n - 1]);
            EXPECT_NE(bsh_check_order(broken, points), "") << kind << " " << n;
        }
    EXPECT_TRUE(bsh_order({}).empty());
}

}  // namespace
}  // namespace myriad::compute
