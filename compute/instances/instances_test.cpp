// Triangles shared by instances against the same scene written out: the same ids, floats, samples, trees and hits, to the bit.
#include <cstdlib>
#include <functional>

#include "compute/bsh/bsh_ref.hpp"
#include "compute/instances/world.hpp"
#include "compute/raytrace/raytrace_testing.hpp"
#include "compute/surface_sampling/surface_sampling.hpp"

namespace myriad::compute {
namespace {

using glm::dvec3;

// Meshes, and where they stand.
struct Shared {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;
    std::vector<Instance> instances;

    // A mesh is a range of stored triangles.
    struct Range {
        uint first, count;
    };
    Range begin() const { return {uint(triangles.size()), 0}; }
    void triangle(Range& mesh, vec3 a, vec3 b, vec3 c) {
        const uint n = uint(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({n, n + 1, n + 2, 0});
        ++mesh.count;
    }
    void place(Range mesh, const glm::mat3& m, vec3 at) {
        const uint id = instances.empty() ? 0 : instances.back().first_id + instances.back().count;
        const uint flags = glm::determinant(glm::dmat3(m)) < 0 ? instance_mirrored : 0;
        instances.push_back({m[0], m[1], m[2], at, id, mesh.first, mesh.count, flags});
    }
    void place_in_world(Range mesh) {
        place(mesh, glm::mat3(1), vec3(0));
        instances.back().flags = instance_in_world;
    }
    WorldTriangles world() const { return {positions, triangles, instances}; }
};

struct Flat {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;

    explicit Flat(const WorldTriangles& world) {
        world.for_each([&](uint id, uint, const Corners& c) {
            EXPECT_EQ(id, triangles.size());
            const uint n = uint(positions.size());
            positions.insert(positions.end(), {c.p0, c.p1, c.p2});
            triangles.push_back({n, n + 1, n + 2, 0});
        });
    }
    WorldTriangles world() const { return {positions, triangles}; }
};

class InstancesTest : public RaytraceTest {
protected:
    // Rotated, scaled by an axis each, mirrored now and then; sheared too.
    glm::mat3 transform(float size = 1, float distortion = 4, float shear = 0) {
        const vec3 x = direction(), y = normalize(cross(x, direction())), z = cross(x, y);
        const auto scale = [&] { return size * std::exp(uniform(-1, 1) * std::log(distortion)) * (random() % 4 ? 1.0f : -1.0f); };
        return glm::mat3(x * scale(), y * scale() + x * (size * uniform(-shear, shear)), z * scale());
    }
    Shared::Range soup(Shared& to, uint n, float size, float extent = 1) {
        Shared::Range mesh = to.begin();
        for (uint i = 0; i < n; ++i) {
            const vec3 c = in_cube(extent);
            to.triangle(mesh, c + size * in_cube(), c + size * in_cube(), c + size * in_cube());
        }
        return mesh;
    }
    std::vector<Ray> rays(uint n, float extent, float far = 0) {
        std::vector<Ray> out;
        for (uint i = 0; i < n; ++i) {
            vec3 d = direction();
            if (i % 6 == 1) d[int(i / 6 % 3)] = 0;
            if (i % 24 == 5) d = vec3(0), d[int(i / 24 % 3)] = i / 72 % 2 ? 1.0f : -1.0f;
            if (i % 7 == 3) d *= 3.0f;
            const vec3 from = i % 3 == 2 ? in_cube(extent) - d * (far / length(d)) : in_cube(1.2f * extent);
            out.push_back({from, 0, d, i % 4 || far > 0 ? INFINITY : 0.7f * extent});
        }
        return out;
    }

    struct Answers {
        std::vector<RayHitRecord> hits;
        std::vector<uint> occluded;
    };
    Answers ask(engine::Device& on, const WorldTriangles& world, const std::vector<Ray>& rays) {
        const Bvh bvh(on, world);
        return {closest(on, bvh, rays), RaytraceTest::occluded(on, bvh, rays)};
    }

    // Returns how many rays hit something.
    size_t same(const Answers& found, const Answers& expected) {
        size_t wrong = 0, hits = 0;
        for (size_t i = 0; i < expected.hits.size(); ++i) {
            const RayHitRecord &a = expected.hits[i], &b = found.hits[i];
            hits += a.triangle != ~0u;
            if (std::memcmp(&a, &b, sizeof a) == 0 && found.occluded[i] == expected.occluded[i]) continue;
            if (++wrong == 1)
                ADD_FAILURE() << "ray " << i << ": expected triangle " << a.triangle << " at " << a.t << " (" << a.u << ", " << a.v << "), found "
                              << b.triangle << " at " << b.t << " (" << b.u << ", " << b.v << "), occluded " << found.occluded[i];
        }
        EXPECT_EQ(wrong, 0u) << "of " << expected.hits.size();
        return hits;
    }
    // Against the twin, which tests every triangle of the scene written out.
    size_t agree(engine::Device& on, const Shared& shared, const std::vector<Ray>& rays) {
        const Flat flat(shared.world());
        const BvhData all = build_bvh(flat.world());
        Answers expected;
        for (const Ray& ray : rays) {
            expected.hits.push_back(closest_ref(all.triangles, ray));
            expected.occluded.push_back(expected.hits.back().triangle != ~0u);
        }
        return same(ask(on, shared.world(), rays), expected);
    }
    size_t agree(const Shared& shared, const std::vector<Ray>& rays) { return agree(device, shared, rays); }
};

TEST(Instances, points_are_those_of_glm_to_the_bit) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-9, 9);
    for (int k = 0; k < 100000; ++k) {
        glm::mat4 m(1);
        for (int c = 0; c < 4; ++c) m[c] = glm::vec4(any(random), any(random), any(random), c == 3);
        const vec3 p(any(random), any(random), any(random));
        const Instance i{vec3(m[0]), vec3(m[1]), vec3(m[2]), vec3(m[3]), 0, 0, 1, 0};
        ASSERT_EQ(instance_point(i, p), vec3(m * glm::vec4(p, 1)));
    }
}

TEST(Instances, ids_find_their_instances) {
    Shared s;
    Shared::Range a = s.begin();
    for (int i = 0; i < 3; ++i) s.triangle(a, vec3(i, 0, 0), vec3(i, 1, 0), vec3(i, 0, 1));
    Shared::Range b = s.begin();
    s.triangle(b, vec3(7, 0, 0), vec3(7, 1, 0), vec3(7, 0, 1));
    s.place(a, glm::mat3(1), vec3(10)), s.place_in_world(b), s.place(a, glm::mat3(-1), vec3(0));
    const WorldTriangles world = s.world();
    EXPECT_EQ(world.count(), 7u);
    EXPECT_EQ(world.corners(2).p0, vec3(12, 10, 10));
    EXPECT_EQ(world.corners(3).p1, vec3(7, 1, 0));
    EXPECT_EQ(world.corners(5).p0, vec3(-1, 0, 0));
    EXPECT_EQ(world.corners(5).p1, vec3(-1, 0, -1)) << "mirrored: the last two change places";
    uint next = 0;
    world.for_each([&](uint id, uint, const Corners& c) {
        EXPECT_EQ(id, next++);
        EXPECT_EQ(c.p2, world.corners(id).p2);
    });
    EXPECT_EQ(next, 7u);
}

TEST(Instances, normals_follow_their_surface) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-2, 2);
    const auto point = [&] { return vec3(any(random), any(random), any(random)); };
    for (int k = 0; k < 2000; ++k) {
        const glm::mat3 m(point(), point(), point());
        const double det = glm::determinant(glm::dmat3(m));
        if (std::abs(det) < 0.5) continue;
        const Instance i{m[0], m[1], m[2], point(), 0, 0, 1, det < 0 ? instance_mirrored : 0};
        const Corners c{point(), point(), point()}, w = instance_corners(i, c);
        const vec3 n = cross(c.p1 - c.p0, c.p2 - c.p0), expected = cross(w.p1 - w.p0, w.p2 - w.p0);
        ASSERT_NEAR(glm::length(normalize(instance_normal(i, n)) - normalize(expected)), 0, 1e-3 + 1e-4 / glm::length(expected));
    }
}

TEST_F(InstancesTest, rays_equal_the_twin) {
    for (const float shear : {0.0f, 1.5f}) {
        Shared s;
        const auto a = soup(s, 150, 0.3f), b = soup(s, 40, 0.6f), c = soup(s, 1, 1), floor_ = soup(s, 60, 0.8f, 3);
        s.place(a, transform(0.5f, 4, shear), in_cube(3));
        s.place_in_world(floor_);
        for (int i = 0; i < 12; ++i) s.place(i % 3 == 0 ? a : i % 3 == 1 ? b : c, transform(0.5f, 4, shear), in_cube(3));
        s.place_in_world(soup(s, 20, 0.8f, 3));
        s.place(b, transform(2), in_cube(3));
        EXPECT_GT(agree(s, rays(4000, 3)), 1000u);
        agree(s, rays(2000, 3, 300));
        agree(s, rays(2000, 3, 1e5f));
    }
}

TEST_F(InstancesTest, rays_equal_the_twin_at_any_scale_and_place) {
    for (const float scale : {1e-6f, 1.0f, 1e6f})
        for (const float place : {0.0f, 100.0f, 2000.0f}) {
            Shared s;
            const auto a = soup(s, 100, 0.3f), b = soup(s, 60, 0.2f);
            const vec3 at = vec3(place, -0.3f * place, 1.7f * place) * scale;
            for (int i = 0; i < 8; ++i) s.place(i % 2 ? a : b, transform(0.6f * scale, 3, 0.5f), at + in_cube(2 * scale));
            auto list = rays(2000, 2);
            for (Ray& r : list) r.origin = r.origin * scale + at, r.t_max *= scale;
            EXPECT_GT(agree(s, list), 100u) << scale << " " << place;
            for (Ray& r : list) r.origin -= r.direction * (1000 * scale), r.t_max = INFINITY;
            agree(s, list);
        }
}

// A mesh far from its own origin, brought back by its instances: large terms cancel.
TEST_F(InstancesTest, rays_equal_the_twin_where_terms_cancel) {
    Shared s;
    Shared::Range a = s.begin();
    for (int i = 0; i < 200; ++i) {
        const vec3 c = vec3(300, -200, 500) + in_cube();
        s.triangle(a, c + 0.3f * in_cube(), c + 0.3f * in_cube(), c + 0.3f * in_cube());
    }
    for (int i = 0; i < 10; ++i) {
        const glm::mat3 m = transform(1, 2);
        s.place(a, m, in_cube(2) - m * vec3(300, -200, 500));
    }
    EXPECT_GT(agree(s, rays(4000, 2)), 1000u);
    agree(s, rays(2000, 2, 500));
}

TEST_F(InstancesTest, lanes_alone_equal_packets) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    Shared s;
    const auto a = soup(s, 150, 0.3f), b = soup(s, 50, 0.5f);
    s.place_in_world(b);
    for (int i = 0; i < 10; ++i) s.place(i % 2 ? a : b, transform(), in_cube(3));
    EXPECT_GT(agree(plain, s, rays(3001, 3)), 1000u);
    EXPECT_EQ(plain.validation_messages(), 0u);
}

// Of triangles at the same t the first is hit, in whatever instance: same mesh, same place, other transforms.
TEST_F(InstancesTest, coincident_instances_tie_by_id) {
    Shared s;
    Shared::Range box = s.begin();
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto corner = [&](float u, float v) {
                vec3 p(0);
                p[axis] = side, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
                return p;
            };
            s.triangle(box, corner(-1, -1), corner(1, -1), corner(1, 1));
            s.triangle(box, corner(-1, -1), corner(1, 1), corner(-1, 1));
        }
    s.place(box, glm::mat3(1), vec3(3));
    s.place(box, glm::mat3(-1), vec3(3));
    s.place(box, glm::mat3(vec3(0, 1, 0), vec3(-1, 0, 0), vec3(0, 0, 1)), vec3(3));
    for (int i = 0; i < 1000; ++i) s.place(box, glm::mat3(1), vec3(3));
    auto list = rays(3000, 2);
    for (Ray& r : list) r.origin += vec3(3);
    EXPECT_GT(agree(s, list), 400u);
    EXPECT_EQ(build_bvh(s.world()).instances.size(), 3u) << "the very same place is looked into once";
}

// Many instances, against the tree over the scene written out: high stacks, long ways down.
TEST_F(InstancesTest, many_instances_equal_one_tree) {
    Shared s;
    const auto a = soup(s, 300, 0.2f), b = soup(s, 37, 0.4f);
    s.place_in_world(soup(s, 500, 1, 40));
    for (int i = 0; i < 3000; ++i) {
        // Clusters that halve in size, for depth.
        const float size = std::ldexp(20.0f, -(i % 9));
        s.place(i % 2 ? a : b, transform(0.05f * size), vec3(size) + in_cube(size));
    }
    const Flat flat(s.world());
    auto list = rays(20000, 20);
    for (size_t i = 0; i < list.size(); i += 2) {
        const float size = std::ldexp(20.0f, -int(i / 2 % 9));
        list[i].direction = vec3(size) + in_cube(size) - list[i].origin;
        list[i].t_max = INFINITY;
    }
    const Answers found = ask(device, s.world(), list);
    EXPECT_GT(same(found, ask(device, flat.world(), list)), 8000u);
    const BvhData data = build_bvh(s.world());
    EXPECT_LE(data.depth, bvh_max_stack);
    EXPECT_EQ(data.triangles.size(), 300u + 37 + 500);
    const BvhData again = build_bvh(s.world());
    ASSERT_EQ(data.nodes.size(), again.nodes.size());
    EXPECT_EQ(0, std::memcmp(data.nodes.data(), again.nodes.data(), data.nodes.size() * sizeof(BvhNode)));
}

// Deep trees on both levels: of 1200 shrinking instances of 1200 shrinking triangles. Written out they would be 1.4 M triangles, so the
// two traversals, whose stacks have nothing in common, are asked instead.
TEST_F(InstancesTest, deep_trees_fit_the_stack) {
    // 1200 nested instances of 1200 nested triangles: some of these rays take more than 49,000 steps, and say so (Bvh's status).
    if (device.loop_limit() != ~0u) GTEST_SKIP() << "this driver ends loops after " << device.loop_limit() << " iterations; the scene needs more";
    Shared s;
    Shared::Range mesh = s.begin();
    const auto near_corner = [&](float size) { return size * (vec3(1) + 0.3f * in_cube()); };
    for (int i = 0; i < 1200; ++i) {
        const float size = std::ldexp(1.0f, -i / 20);
        s.triangle(mesh, near_corner(size), near_corner(size), near_corner(size));
    }
    for (int i = 0; i < 1200; ++i) s.place(mesh, transform(std::ldexp(0.1f, 20 - i / 20), 1.2f), near_corner(std::ldexp(1.0f, 20 - i / 20)));
    const BvhData data = build_bvh(s.world());
    EXPECT_GT(data.depth, 16u) << "all of the first three registers of the packet's stack are to be used";
    EXPECT_LE(data.depth, bvh_max_stack);
    std::vector<Ray> list;
    for (int i = 0; i < 1000; ++i) {
        const vec3 to = near_corner(std::ldexp(1.0f, 20 - i % 60));
        list.push_back(i % 2 ? Ray{vec3(3e6f), 0, to - vec3(3e6f), INFINITY} : Ray{to, 0, direction(), INFINITY});
    }
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    EXPECT_GT(same(ask(device, s.world(), list), ask(plain, s.world(), list)), 200u);
}

TEST_F(InstancesTest, nothing_escapes_a_sphere_of_any_shape) {
    Shared s;
    Shared::Range sphere = s.begin();
    const int rings = 24, segments = 48;
    const auto at = [&](int r, int k) {
        const double a = M_PI * r / rings, b = 2 * M_PI * (k % segments) / segments;
        return vec3(sin(a) * cos(b), sin(a) * sin(b), cos(a));
    };
    const vec3 poles[2] = {at(0, 0), at(rings, 0)};
    const auto vertex = [&](int r, int k) { return r == 0 ? poles[0] : r == rings ? poles[1] : at(r, k); };
    for (int r = 0; r < rings; ++r)
        for (int k = 0; k < segments; ++k) {
            if (r > 0) s.triangle(sphere, vertex(r, k), vertex(r + 1, k), vertex(r, k + 1));
            if (r + 1 < rings) s.triangle(sphere, vertex(r + 1, k), vertex(r + 1, k + 1), vertex(r, k + 1));
        }
    for (int k = 0; k < 6; ++k) {
        s.instances.clear();
        const glm::mat3 m = transform(k < 3 ? 1.0f : 300.0f, 10, 1);
        const vec3 centre = in_cube(k % 2 ? 1000.0f : 1.0f);
        s.place(sphere, m, centre);
        std::vector<Ray> list;
        const Flat flat(s.world());
        for (int i = 0; i < 20000; ++i) {
            const vec3 from = centre + m * in_cube(0.3f);
            const vec3 to = i % 2 ? flat.positions[random() % flat.positions.size()] : from + direction();
            list.push_back({from, 0, to - from, INFINITY});
        }
        const Answers found = ask(device, s.world(), list);
        EXPECT_EQ(std::count(found.occluded.begin(), found.occluded.end(), 0u), 0) << k;
        EXPECT_EQ(std::count_if(found.hits.begin(), found.hits.end(), [](auto& h) { return h.triangle == ~0u; }), 0) << k;
        size_t inward = 0;
        for (const RayHitRecord& h : found.hits) inward += h.front;
        EXPECT_LE(inward, list.size() / 1000) << "seen from inside, faces show their backs, mirrored or not";
    }
}

TEST_F(InstancesTest, rays_leave_their_own_surface) {
    for (const float scale : {1e-5f, 1.0f, 1e4f}) {
        Shared s;
        const auto mesh = soup(s, 1, 1);
        for (int i = 0; i < 200; ++i) s.place(mesh, transform(scale, 6), in_cube(1e4f * scale));
        std::vector<Ray> list;
        std::vector<uint> own;
        const WorldTriangles world = s.world();
        for (uint id = 0; id < world.count(); ++id) {
            const auto [p0, p1, p2] = world.corners(id);
            const vec3 n = vec3(normalize(cross(dvec3(p1) - dvec3(p0), dvec3(p2) - dvec3(p0))));
            for (int i = 0; i < 20; ++i) {
                float u = uniform(), v = uniform();
                if (u + v > 1) u = 1 - u, v = 1 - v;
                vec3 d = direction();
                d = normalize(d - n * dot(d, n) + n * (i % 2 ? std::abs(dot(d, n)) : 1e-3f));
                list.push_back({ray_origin((1 - u - v) * p0 + u * p1 + v * p2, n, ray_reach(p0, p1, p2)), 0, d, INFINITY});
                own.push_back(id);
            }
        }
        const Answers found = ask(device, world, list);
        size_t blocked = 0;
        for (size_t i = 0; i < list.size(); ++i) blocked += found.hits[i].triangle == own[i];
        EXPECT_EQ(blocked, 0u) << scale;
    }
}

TEST_F(InstancesTest, nothing_to_hit) {
    Shared s;
    Shared::Range needles = s.begin();
    s.triangle(needles, vec3(1), vec3(1), vec3(2));
    s.triangle(needles, vec3(NAN), vec3(1), vec3(2));
    s.place(needles, glm::mat3(2), vec3(0)), s.place(needles, transform(), vec3(1));
    for (const RayHitRecord& h : ask(device, s.world(), rays(100, 2)).hits) EXPECT_EQ(h.triangle, ~0u);
    EXPECT_EQ(Bvh(device, s.world()).dropped(), 2u);
}

TEST_F(InstancesTest, samples_and_their_tree_are_the_same) {
    Shared s;
    const auto a = soup(s, 300, 0.3f), b = soup(s, 2, 1);
    s.place(a, transform(), in_cube(5));
    s.place_in_world(soup(s, 20, 1, 5));
    for (int i = 0; i < 9; ++i) s.place(i % 2 ? a : b, transform(0.2f + float(i)), in_cube(9));
    const Flat flat(s.world());
    const SurfaceSampling shared = sample_surface(s.world(), 13, 7), written = sample_surface(flat.world(), 13, 7);
    EXPECT_EQ(shared.area, written.area);
    EXPECT_EQ(shared.radius, written.radius);
    ASSERT_EQ(shared.samples.size(), written.samples.size());
    EXPECT_EQ(0, std::memcmp(shared.samples.data(), written.samples.data(), shared.samples.size() * sizeof(SurfaceSample)));
    // By area over instances: each gets what it is due, but for the samples at the ends of its pieces of the curve.
    std::vector<double> area(s.instances.size()), found(area.size());
    const auto index_of = [&](uint id) {
        size_t i = 0;
        while (i + 1 < s.instances.size() && s.instances[i + 1].first_id <= id) ++i;
        return i;
    };
    flat.world().for_each([&](uint id, uint, const Corners& c) {
        area[index_of(id)] += 0.5 * glm::length(cross(dvec3(c.p1) - dvec3(c.p0), dvec3(c.p2) - dvec3(c.p0)));
    });
    for (const SurfaceSample& sample : shared.samples) ++found[index_of(sample.triangle)];
    for (size_t i = 0; i < area.size(); ++i) {
        const double due = area[i] / shared.area * double(shared.samples.size());
        EXPECT_NEAR(found[i], due, 3 * std::sqrt(double(s.instances[i].count)) + 2) << i;
    }

    const auto tree = [&](const WorldTriangles& world, const std::vector<Instance>& instances) {
        Bsh bsh(device, world, 13, 7);
        const auto positions = engine::upload(device, "test", "positions", world.positions);
        const auto triangles = engine::upload(device, "test", "triangles", world.triangles);
        const auto placed = engine::upload(device, "test", "instances", instances);
        engine::Recorder recorder(device);
        bsh.refit(recorder, positions, triangles, instances.empty() ? nullptr : &placed);
        recorder.submit_and_wait();
        return bsh_download(device, bsh);
    };
    const BshArrays one = tree(s.world(), s.instances), two = tree(flat.world(), {});
    EXPECT_EQ(one.leaves, two.leaves);
    EXPECT_TRUE(engine::same(one.frames, two.frames));
    EXPECT_TRUE(engine::same(one.spheres, two.spheres));
    EXPECT_TRUE(engine::same(one.cones, two.cones));
    EXPECT_TRUE(engine::same(one.boxes, two.boxes));
}

// What instances take: a node and an entry each, whatever their mesh.
TEST_F(InstancesTest, memory_is_that_of_one_mesh) {
    Shared s;
    const auto a = soup(s, 5000, 0.1f);
    s.place(a, transform(), in_cube(9)), s.place(a, transform(), in_cube(9));
    const uint64_t two = Bvh(device, s.world()).bytes();
    for (int i = 2; i < 200; ++i) s.place(a, transform(), in_cube(30));
    const uint64_t many = Bvh(device, s.world()).bytes(), written = Bvh(device, Flat(s.world()).world()).bytes();
    EXPECT_LT(many, two + 198 * (sizeof(Instance) + 2 * sizeof(BvhNode)));
    EXPECT_GT(written, 80 * many);
}

}  // namespace
}  // namespace myriad::compute
