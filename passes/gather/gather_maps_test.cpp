// Visibility by maps: the query's properties on the host, and the kernel against maps of exact depths.
#include <array>
#include <functional>
#include <numeric>

#include "passes/gather/gather_testing.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

class GatherMapsTest : public GatherTest {
protected:
    vec3 any_direction() {
        switch (random() % 4) {
            case 0: return {random() % 2 ? 1.0f : -1.0f, 0.01f * uniform(), 0.01f * uniform()};  // the axis
            case 1: return {1e-4f * uniform(), uniform(), uniform()};                            // the equator
            case 2: return vec3(random() % 3 == 0, random() % 3 == 1, random() % 3 == 2) + 1e-20f;  // on an axis
            default: return direction();
        }
    }
    static float infinity() { return std::numeric_limits<float>::infinity(); }
    // What a plane through x leaves in texel `index` of a map.
    static float plane_depth(const vec3& vpl, const vec3& x, const vec3& n, uint index, uint size) {
        const dvec3 w(unproject(index / (size * size), texel_middle(index % size, index / size % size, size)));
        const double t = dot(dvec3(x) - dvec3(vpl), dvec3(n)) / dot(w, dvec3(n));
        return t > 0 ? float(t) : infinity();
    }
    // The share of x that is seen where texel t stores stored(t).
    static float seen(const MapQuery& q, uint size, const std::function<float(const MapTexel&)>& stored) {
        vec4 answers;
        for (int i = 0; i < 4; ++i) {
            const MapTexel t = map_texel(q, i % 2, i / 2, size);
            answers[i] = map_seen(stored(t), t);
        }
        return map_blend(q, answers);
    }
};

// Up to 89 degrees from the normal, at any distance, in any direction, the plane that a receiver lies on does not hide it.
TEST_F(GatherMapsTest, a_plane_does_not_shadow_itself) {
    for (int i = 0; i < 200000; ++i) {
        const uint size = std::array{2u, 8u, 32u, 33u, 256u, 1024u}[random() % 6];
        const float distance = std::pow(10.0f, uniform(-6, 6));
        const vec3 to_vpl = -normalize(any_direction());
        vec3 side = cross(to_vpl, direction());
        if (dot(side, side) < 1e-4f) continue;
        const float angle = 1.5533f * std::sqrt(uniform(0, 1));
        const vec3 n = std::cos(angle) * to_vpl + std::sin(angle) * normalize(side);
        const vec3 x = distance * point(), vpl = x + distance * to_vpl;
        if (dot(n, vpl - x) < 0.0174f * length(vpl - x)) continue;
        const auto stored = [&](const MapTexel& t) { return plane_depth(vpl, x, n, t.index, size); };
        ASSERT_EQ(seen(map_query(x, n, vpl, size, 0.01f), size, stored), 1.0f) << "size " << size << ", angle " << angle;
        // With the normal as the G-buffer keeps it, off by 4e-5, the default bias of half a texel suffices for maps up to 256.
        if (size > 256) continue;
        ASSERT_EQ(seen(map_query(x, unpack_direction(pack_direction(n)), vpl, size, 0.5f), size, stored), 1.0f) << size << " " << angle;
    }
}

// What is clearly nearer hides: a receiver that faces the VPL within 60 degrees, an occluder at 90 % of its distance, and texels that
// subtend so little that neither the bias nor the receiver's own plane reach that far.
TEST_F(GatherMapsTest, an_occluder_hides) {
    for (int i = 0; i < 100000; ++i) {
        const uint size = std::array{64u, 128u, 1024u}[random() % 3];
        const vec3 to_vpl = -normalize(any_direction());
        const vec3 n = normalize(to_vpl + 0.86f * direction());
        const vec3 x = point(), vpl = x + to_vpl * std::pow(10.0f, uniform(-2, 2));
        const float distance = length(vpl - x);
        const MapQuery q = map_query(x, n, vpl, size, 0.5f);
        // tan(60) for the slope of the plane over the two half diagonals that a texel's middle may be off, and a half for the bias.
        const float reach = (2 * 1.8f + 0.5f) * texel_angle(project(x - vpl), size) * distance;
        ASSERT_EQ(seen(q, size, [&](const MapTexel&) { return distance - 1.1f * reach; }), 0.0f) << size;
        ASSERT_EQ(seen(q, size, [&](const MapTexel&) { return distance; }), 1.0f);
        ASSERT_EQ(seen(q, size, [&](const MapTexel&) { return infinity(); }), 1.0f);
        if (size < 1024) continue;
        ASSERT_EQ(seen(q, size, [&](const MapTexel&) { return 0.9f * distance; }), 0.0f);
    }
}

TEST_F(GatherMapsTest, query_is_in_range_where_everything_coincides) {
    for (const vec3& x : {vec3(0), vec3(1e-30f), vec3(1e-45f, 0, 0), vec3(1e12f), vec3(-1, 0, 0), vec3(0, 1, 0)})
        for (const vec3& n : {vec3(1, 0, 0), vec3(0, 0, -1)})
            for (uint size : {2u, 1024u})
                for (int i = 0; i < 4; ++i)
                    ASSERT_LT(map_texel(map_query(x, n, vec3(0), size, 0.5f), i % 2, i / 2, size).index, map_texels(size));
}

TEST_F(GatherMapsTest, equals_the_twin_on_random_maps) {
    for (uint size : {2u, 7u, 32u})
        for (uint block : {1u, 2u, 4u}) {
            SCOPED_TRACE(testing::Message() << "size " << size << ", block " << block);
            HostGBuffer g = random_gbuffer(21, 15);
            if (size == 32) polish(g);
            const auto vpls = random_vpls(90);
            const auto atlas = random_atlas(vpls.size(), size, 3);
            const auto expected = gather_ref(g, vpls, block, 3, [&](size_t p, size_t i) {
                return map_seen_ref(dvec3(g.position(p)), dvec3(g.geometric(p)), dvec3(vpls[i].position), &atlas[i * map_texels(size)], size, 0.5);
            });
            EXPECT_LT(doubt(expected), 0.01);
            const Options whole{.block = block, .bound = 3, .atlas = &atlas, .map_size = size, .bias = 0.5f};
            const auto got = run(g, vpls, whole);
            EXPECT_TRUE(near(expected, got));
            Options split = whole;
            split.parts = {block * block * 2, 64};
            EXPECT_TRUE(engine::same(got, run(g, vpls, split)));

            // VPLs in another order, listed by the sets that they were in: the same sums, in another order. Listed as they are: the same bits.
            std::vector<uint> shuffled(vpls.size()), as_they_are, listed;
            std::iota(shuffled.begin(), shuffled.end(), 0u);
            const auto list = [&] {
                std::vector<uint> codes;
                for (uint i = 0; i < shuffled.size(); ++i) codes.push_back(shuffled[i] % (block * block) << gather_listed_bits | i);
                std::ranges::sort(codes);
                return codes;
            };
            as_they_are = list();
            Options same_order = split;
            same_order.listed = &as_they_are;
            EXPECT_TRUE(engine::same(got, run(g, vpls, same_order)));
            std::ranges::shuffle(shuffled, random);
            listed = list();
            std::vector<Vpl> moved;
            std::vector<uint> moved_atlas;
            for (uint i : shuffled) {
                moved.push_back(vpls[i]);
                moved_atlas.insert(moved_atlas.end(), atlas.begin() + i * map_texels(size), atlas.begin() + (i + 1) * map_texels(size));
            }
            Options other_order = split;
            other_order.listed = &listed, other_order.atlas = &moved_atlas;
            EXPECT_TRUE(near(expected, run(g, moved, other_order)));
        }
}

// Maps that lack what their views share, beside maps that hold it: as the map that both would make. Some share nothing, some see nothing.
TEST_F(GatherMapsTest, asks_own_maps_and_shared_ones) {
    const uint size = 9, texels = map_texels(size), n = 40, shared_maps = 5;
    const HostGBuffer g = random_gbuffer(21, 15);
    const auto vpls = random_vpls(n);
    std::vector<uint> apart((n + shared_maps) * texels);
    for (uint& texel : apart) texel = floatBitsToUint(random() % 3 ? uniform(0, 3) : infinity());
    std::vector<uint> whole(apart.begin(), apart.begin() + n * texels);
    std::vector<SharedMap> asked;
    for (uint i = 0; i < n; ++i) {
        asked.push_back({0.1f * point(), i % 7 == 0 ? fuse_no_map : (n + uint(random() % shared_maps)) * texels});
        for (uint t = 0; t < texels && asked[i].first != fuse_no_map; ++t) {
            const vec3 w = unproject(t / (size * size), texel_middle(t % size, t / size % size, size));
            const float far = uintBitsToFloat(apart[asked[i].first + t]);
            if (far < infinity()) whole[i * texels + t] = std::min(whole[i * texels + t], floatBitsToUint(fused_depth(asked[i].offset, w, far)));
        }
    }
    for (uint block : {1u, 4u}) {
        const auto expected = gather_ref(g, vpls, block, 3, [&](size_t p, size_t i) {
            return map_seen_ref(dvec3(g.position(p)), dvec3(g.geometric(p)), dvec3(vpls[i].position), &whole[i * texels], size, 0.5);
        });
        const auto got = run(g, vpls, {.block = block, .bound = 3, .atlas = &apart, .map_size = size, .bias = 0.5f, .asked = &asked});
        EXPECT_TRUE(near(expected, got));
        EXPECT_FALSE(near(expected, run(g, vpls, {.block = block, .bound = 3, .atlas = &apart, .map_size = size, .bias = 0.5f}))) << "not a test";
    }
}

// With maps of exact depths, what is left of error is their resolution: it falls as maps grow.
TEST_F(GatherMapsTest, exact_maps_tend_to_exact_visibility) {
    TestScene scene;
    scene.material(vec3(1));
    scene.room(vec3(-2), vec3(2), 0);
    scene.quad({-1, -1, -1}, {2, 0, 0}, {0, 0, 2}, 0);
    scene.quad({0.5f, -0.5f, -2}, {0, 1, 0}, {0, 0, 2.5f}, 0);
    const auto& positions = scene.triangles.positions;
    const auto& triangles = scene.triangles.triangles;
    struct Place {
        vec3 at, normal;
    };
    const auto place = [&] {
        const uvec4& t = triangles[random() % triangles.size()];
        const float u = uniform(0.05f, 0.45f), v = uniform(0.05f, 0.45f);
        const vec3 n = scene.triangles.normals[t.x];
        return Place{(1 - u - v) * positions[t.x] + u * positions[t.y] + v * positions[t.z] + 1e-5f * n, n};
    };
    HostGBuffer g(24, 24);
    std::vector<Vpl> vpls;
    for (size_t i = 0; i < g.pixels(); ++i) {
        const Place p = place();
        g.put(i, p.at, p.normal);
    }
    for (int i = 0; i < 12; ++i) {
        const Place p = place();
        vpls.push_back(vpl(p.at, p.normal, vec3(1)));
    }
    const auto exact = gather_ref(g, vpls, 1, 1, [&](size_t p, size_t i) { return ray_seen_ref(dvec3(g.position(p)), dvec3(vpls[i].position), scene.triangles); });
    double light = 0, before = 1;
    for (const GatherRef& r : exact) light += r.irradiance.x;
    for (uint size : {8u, 32u, 128u}) {
        const auto atlas = exact_atlas(vpls, scene.triangles, size);
        const auto got = run(g, vpls, {.bound = 1, .atlas = &atlas, .map_size = size, .bias = 0.5f});
        double error = 0;
        for (size_t i = 0; i < got.size(); ++i) error += std::abs(got[i].x - exact[i].irradiance.x) / light;
        EXPECT_LT(error, 0.6 * before) << "size " << size;
        before = error;
    }
    EXPECT_LT(before, 0.02);
}

// As a receiver moves from the middle of one texel to that of the next, which is hidden, its share falls evenly from 1 to 0.
TEST_F(GatherMapsTest, shadows_end_gradually) {
    const uint size = 16;
    for (float at = 0.05f; at < 1; at += 0.1f) {
        const vec2 middle = texel_middle(5, 9, size);
        const vec3 x = 2.0f * unproject(half_back, vec2(middle.x + at * 2 / float(size), middle.y));
        const MapQuery q = map_query(x, -normalize(x), vec3(0), size, 0.5f);
        const uint hidden = texel_index(half_back, 6, 9, size);
        EXPECT_NEAR(seen(q, size, [&](const MapTexel& t) { return t.index == hidden ? 1.0f : infinity(); }), 1 - at, 1e-5f);
    }
}

TEST_F(GatherMapsTest, twin_sees_what_it_must) {
    std::vector<uint> map(map_texels(9), floatBitsToUint(1.0f));
    const dvec3 x(3, 1e-3, 1e-3), n(-1, 0, 0), origin(0);
    const auto share = [&](const dvec3& at) { return map_seen_ref(at, n, origin, map.data(), 9, 0.5).share; };
    EXPECT_EQ(share(x), 0);
    map.assign(map.size(), floatBitsToUint(3.1f));
    EXPECT_NEAR(share(x), 1, 1e-12);
    map[texel_index(half_front, 4, 4, 9)] = floatBitsToUint(1.0f);  // the texel around the axis, and no other
    EXPECT_NEAR(share(x), 0.0015, 1e-5);                              // a texel is 2/3 wide at this distance: d.y = 6 u
    EXPECT_NEAR(share({-3, 0.1, 0.1}), 1, 1e-12);
    EXPECT_NEAR(share({3, 1.6, 0.1}), 1, 1e-12);
    EXPECT_LT(map_seen_ref(x, n, origin, map.data(), 9, 0.5).slack, 1e-5);
    map[texel_index(half_front, 4, 4, 9)] = floatBitsToUint(2.8f);  // within rounding of nothing: sure
    EXPECT_LT(map_seen_ref(x, n, origin, map.data(), 9, 0.5).slack, 1e-5);
    EXPECT_GE(map_seen_ref({3, 1, 1}, {0, 1, 0}, {0, 1, 0}, map.data(), 9, 0.5).slack, 0.5);  // along its own plane
}

TEST_F(GatherMapsTest, comparator_sees_another_map) {
    const HostGBuffer g = random_gbuffer(12, 12);
    const auto vpls = random_vpls(20);
    const std::vector<uint> atlas(vpls.size() * map_texels(8), floatBitsToUint(0.9f));
    EXPECT_FALSE(near(gather_ref(g, vpls, 1, 3), run(g, vpls, {.bound = 3, .atlas = &atlas, .map_size = 8})));
}

}  // namespace
}  // namespace myriad::passes
