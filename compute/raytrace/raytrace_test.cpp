#include <cstdlib>

#include <embree3/rtcore.h>

#include "compute/kernels.hpp"
#include "compute/raytrace/raytrace_testing.hpp"

namespace myriad::compute {
namespace {

const Mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2, 0}}};

TEST_F(RaytraceTest, one_triangle_by_hand) {
    const auto hits = closest(one, {{{0.25f, 0.5f, 2}, 0, {0, 0, -1}, INFINITY},
                                    {{0.25f, 0.5f, -2}, 0, {0, 0, 4}, INFINITY},
                                    {{0.25f, 0.5f, 2}, 0, {0, 0, 1}, INFINITY},
                                    {{0.75f, 0.5f, 2}, 0, {0, 0, -1}, INFINITY},
                                    {{0.25f, 0.5f, 2}, 0, {0, 0, -1}, 2},
                                    {{0.25f, 0.5f, 2}, 2, {0, 0, -1}, 9}});
    EXPECT_EQ(hits[0].triangle, 0u);
    EXPECT_EQ(hits[0].t, 2); EXPECT_EQ(hits[0].u, 0.25f); EXPECT_EQ(hits[0].v, 0.5f); EXPECT_EQ(hits[0].front, 1u);
    EXPECT_EQ(hits[1].t, 0.5f); EXPECT_EQ(hits[1].front, 0u);
    for (int i = 2; i < 6; ++i) EXPECT_EQ(hits[i].triangle, ~0u) << i;  // behind, beside, and the interval is open
}

TEST_F(RaytraceTest, twin_agrees_with_doubles) {
    const Mesh m = soup(300, 0.3f);
    const BvhData all = build_bvh(m.world());
    uint hits = 0;
    for (const Ray& ray : random_rays(3000)) {
        const ExactHit exact = closest_exact(m.positions, m.triangles, ray);
        const RayHitRecord found = closest_ref(all.triangles, ray);
        if (std::abs(exact.margin) < 1e-4) continue;
        ASSERT_EQ(found.triangle, exact.triangle);
        if (found.triangle == ~0u) continue;
        ++hits;
        EXPECT_NEAR(found.t, exact.t, 1e-4 * exact.t + 1e-6);
        EXPECT_NEAR(found.u, exact.u, 1e-3); EXPECT_NEAR(found.v, exact.v, 1e-3);
    }
    EXPECT_GT(hits, 500u);
}

TEST_F(RaytraceTest, equals_the_twin_at_boundary_counts) {
    for (uint triangles : {0, 1, 2, 3, 4, 5, 8, 9, 33, 1000}) {
        const Mesh m = soup(triangles, 0.4f);
        for (uint rays : {0, 1, 7, 8, 9, 63, 64, 65, 500}) agree(m, random_rays(rays));
    }
}

TEST_F(RaytraceTest, equals_the_twin_in_soups_of_all_sizes) {
    for (float size : {0.001f, 0.05f, 1.0f}) {
        const Mesh m = soup(5000, size);
        agree(device, m, random_rays(4000), BvhQuality::quick);
        agree(device, m, random_rays(4000), BvhQuality::best);
    }
}

TEST_F(RaytraceTest, lanes_alone_equal_packets) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    for (uint n : {0, 1, 40, 3000}) agree(plain, soup(n, 0.2f), random_rays(2001));
    EXPECT_EQ(plain.validation_messages(), 0u);
}

// Grids make rays run along edges, through vertices and in planes; every axis and sign, and directions with zeros.
TEST_F(RaytraceTest, grids_and_axes) {
    Mesh m;
    for (int x = 0; x < 5; ++x)
        for (int y = 0; y < 5; ++y)
            for (int z = 0; z < 5; ++z) m.box(vec3(x, y, z), vec3(x, y, z) + vec3(z % 2 ? 1.0f : 0.5f));
    std::vector<Ray> rays;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                for (int k = 0; k < 60 && (x || y || z); ++k) {
                    const vec3 from = vec3(random() % 13, random() % 13, random() % 13) * 0.5f - vec3(0.5f);
                    rays.push_back({from, 0, vec3(x, y, z), INFINITY});
                    rays.push_back({from - 1e6f * vec3(x, y, z), 0, vec3(x, y, z), INFINITY});
                    if (y || z) rays.push_back({from, 0, vec3(x * 1e-30f, y, z * 1e-6f), INFINITY});
                }
    agree(m, rays);
}

TEST_F(RaytraceTest, scales_and_places) {
    for (float scale : {1e-6f, 1.0f, 1e6f})
        for (float place : {0.0f, 1.0f, 1e6f}) {
            Mesh m = soup(1000, 0.2f);
            m.box(vec3(-0.3f), vec3(0.2f));
            auto rays = random_rays(1000);
            for (vec3& p : m.positions) p = p * scale + vec3(place * scale, -place, 0);
            for (Ray& r : rays) {
                r.origin = r.origin * scale + vec3(place * scale, -place, 0);
                if (r.t_min > 0) r.direction *= scale;
            }
            agree(m, rays);
            for (Ray& r : rays) r.origin -= r.direction / glm::length(r.direction) * 1e6f * scale, r.t_max = INFINITY;
            agree(m, rays);
        }
}

TEST_F(RaytraceTest, nothing_escapes_a_sphere) {
    watertight(Mesh::sphere(60, 120, 1, vec3(0)), vec3(0), 0, 20000);
    watertight(Mesh::sphere(60, 120, 1, vec3(0)), vec3(0), 0.5f, 100000);
    watertight(Mesh::sphere(8, 700, 1e6f, vec3(3e6f, 0, 1)), vec3(3e6f, 0, 1), 1e5f, 50000);  // slivers
    watertight(Mesh::sphere(40, 80, 1e-6f, vec3(2e-6f, 0, 0)), vec3(2e-6f, 0, 0), 5e-7f, 50000);
    watertight(Mesh::sphere(40, 80, 50, vec3(1e6f, -1e6f, 0)), vec3(1e6f, -1e6f, 0), 20, 50000);  // vertices rounded to 1/16
}

TEST_F(RaytraceTest, nothing_escapes_a_box) {
    Mesh m;
    m.box(vec3(-1, -2, -3), vec3(1, 2, 3));
    watertight(m, vec3(0), 0, 10000);
    watertight(m, vec3(0), 0.9f, 100000);
    Mesh flat;  // origins keep the distance from the faces that ray_origin gives: 2e-3 where coordinates reach 1000
    flat.box(vec3(-1000, -1, -0.02f), vec3(1000, 1, 0.02f));
    watertight(flat, vec3(0), 0.018f, 100000);
}

TEST_F(RaytraceTest, zero_area_and_broken_triangles_are_dropped) {
    Mesh m;
    m.triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    m.triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0});
    m.triangle({0, 0, 0}, {0, NAN, 0}, {1, 0, 0});
    m.triangle({0, 0, 0}, {0, INFINITY, 0}, {1, 0, 0});
    const Bvh empty(device, m.world());
    EXPECT_EQ(empty.triangles(), 0u); EXPECT_EQ(empty.dropped(), 4u);
    agree(m, random_rays(100));
    for (uint i = 0; i < 500; ++i) {  // needles down to denormals
        const vec3 a = in_cube(), along = in_cube();
        m.triangle(a, a + along, a + 0.5f * along + std::ldexp(1.0f, -int(i) / 4) * in_cube());
    }
    agree(m, random_rays(3000));
}

TEST_F(RaytraceTest, a_million_coincident_triangles) {
    Mesh m = one;
    m.triangles.resize(1000000, m.triangles[0]);
    const Bvh bvh(device, m.world());
    EXPECT_EQ(bvh.triangles(), 1u);
    EXPECT_EQ(closest(device, bvh, {{{0.2f, 0.2f, 1}, 0, {0, 0, -1}, 9}})[0].triangle, 0u);
    // Almost coincident ones cannot be dropped: the tree must stay within the stack, and find the top of the heap.
    Mesh heap;
    for (uint i = 0; i < 100000; ++i) heap.triangle({0, 0, i * 1e-9f}, {1, 0, i * 1e-9f}, {0, 1, i * 1e-9f});
    const Bvh tall(device, heap.world());
    EXPECT_LE(tall.depth(), bvh_max_depth);
    EXPECT_NEAR(closest(device, tall, {{{0.2f, 0.2f, 1}, 0, {0, 0, -1}, 9}})[0].t, 1 - 1e-4f, 1e-6f);
}

// Clusters that halve in size towards a corner: the cheapest tree is as deep as they are many, so that stacks are long.
TEST_F(RaytraceTest, deep_trees_fit_the_stack) {
    Mesh m;
    for (int i = 0; i < 60; ++i) {
        const float s = std::ldexp(1.0f, 20 - i);
        for (int k = 0; k < 20; ++k) m.triangle(s * (vec3(1) + 0.3f * in_cube()), s * (vec3(1) + 0.3f * in_cube()), s * (vec3(1) + 0.3f * in_cube()));
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 4000; ++i) {
        const vec3 to = std::ldexp(1.0f, 20 - i % 60) * in_cube();
        rays.push_back(i % 2 ? Ray{vec3(2e6f), 0, to - vec3(2e6f), INFINITY} : Ray{to, 0, vec3(1) + 0.5f * in_cube(), INFINITY});
    }
    for (auto quality : {BvhQuality::quick, BvhQuality::best}) {
        const uint depth = build_bvh(m.world(), quality).depth;
        EXPECT_GT(depth, 16u) << "all three registers of the packet's stack are to be used";
        EXPECT_LE(depth, bvh_max_depth);
        agree(device, m, rays, quality);
    }
}

TEST_F(RaytraceTest, boxes_contain_their_triangles_and_builds_repeat) {
    for (float place : {0.0f, 1e6f}) {
        Mesh m = soup(30000, 0.02f);
        for (vec3& p : m.positions) p += vec3(place, 0, -place);
        const BvhData data = build_bvh(m.world());
        EXPECT_EQ(bvh_check(data), "");
        EXPECT_EQ(data.triangles.size() + data.dropped, m.triangles.size());
        for (auto quality : {BvhQuality::quick, BvhQuality::best}) {
            const BvhData first = build_bvh(m.world(), quality);
            for (uint32_t threads : {1, 2, 3, 8}) {
                const BvhData again = build_bvh(m.world(), quality, threads);
                ASSERT_EQ(first.nodes.size(), again.nodes.size());
                ASSERT_EQ(first.triangles.size(), again.triangles.size());
                EXPECT_EQ(0, std::memcmp(first.nodes.data(), again.nodes.data(), first.nodes.size() * sizeof(BvhNode)));
                EXPECT_EQ(0, std::memcmp(first.triangles.data(), again.triangles.data(), first.triangles.size() * sizeof(BvhTriangle)));
            }
        }
    }
}

// A point on a triangle, in floats, and the ray that leaves it: near and far, small and large, upright and grazing.
TEST_F(RaytraceTest, rays_leave_their_own_surface) {
    for (float scale : {1e-6f, 1.0f, 1e4f})
        for (float place : {0.0f, 10.0f, 1e4f}) {
            uint blocked = 0;
            for (int k = 0; k < 20; ++k) {
                Mesh m;
                m.triangle(scale * (in_cube() + vec3(place)), scale * (in_cube() + vec3(place)), scale * (in_cube() + vec3(place)));
                const auto& p = m.positions;
                const glm::dvec3 area = cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
                const vec3 n = vec3(normalize(area));
                std::vector<Ray> rays;
                for (int i = 0; i < 500; ++i) {
                    float u = uniform(), v = uniform();
                    if (u + v > 1) u = 1 - u, v = 1 - v;
                    vec3 d = direction();
                    d = normalize(d - n * dot(d, n) + n * (i % 2 ? std::abs(dot(d, n)) : 1e-3f));
                    rays.push_back({ray_origin((1 - u - v) * p[0] + u * p[1] + v * p[2], n, ray_reach(p[0], p[1], p[2])), 0, d, INFINITY});
                }
                for (uint b : occluded(m, rays)) blocked += b;
            }
            EXPECT_EQ(blocked, 0u) << "scale " << scale << ", place " << place;
        }
}

// Cut-outs and blended surfaces of all kinds, to the bit: wraps, both sets, transforms, vertex colours; shared and not.
TEST_F(RaytraceTest, rays_pass_where_a_triangle_is_not) {
    setenv("MYRIAD_PLAIN_GROUPS", "1", 1);
    engine::Device plain({.select = "", .validation = true, .memory_limit = 0});
    unsetenv("MYRIAD_PLAIN_GROUPS");
    for (engine::Device* on : {&device, &plain})
        for (float size : {0.05f, 0.5f, 2.0f}) {
            OpacityScene scene = OpacityScene::soup(1500, size, random);
            const auto rays = random_rays(3001);
            const DeviceOpacity opacity(*on, scene);
            for (auto quality : {BvhQuality::quick, BvhQuality::best}) agree(*on, scene.world(), scene.world(), rays, quality, opacity.reader());
            // The scene has holes that rays pass, and not all of them.
            const auto triangles = build_bvh(WorldTriangles{scene.positions, scene.triangles}).triangles;
            uint solid = 0, holed = 0;
            for (const Ray& ray : rays) solid += occluded_ref(triangles, ray), holed += occluded_ref(triangles, ray, scene.world());
            EXPECT_LT(holed, solid) << size;
            EXPECT_GT(holed, solid / 3) << size;

            scene.share(random);
            const OpacityScene written_out = scene.written_out();
            const DeviceOpacity shared(*on, scene);
            agree(*on, scene.world(), written_out.world(), rays, BvhQuality::quick, shared.reader());
        }
    EXPECT_EQ(plain.validation_messages(), 0u);
}

TEST_F(RaytraceTest, a_cut_out_by_hand) {
    OpacityScene scene;
    scene.texels = {0x00ffffff, 0xffffffff};  // the left half is not there
    scene.square(0, scene.material({{0, 2, 1, wrap_clamp | wrap_clamp << 2, {1, 0}, {0, 1}, {0, 0}}, 1, 0.5f}));
    scene.square(-1, scene.material(Opacity::opaque()));
    scene.square(-2, scene.material({.alpha = 0.25f, .cutoff = 0.5f}));  // nowhere
    const DeviceOpacity opacity(device, scene);
    const Bvh bvh(device, scene.world(), BvhQuality::quick, opacity.reader());
    EXPECT_TRUE(bvh.asks());
    EXPECT_EQ(bvh.triangles(), 4u);
    EXPECT_EQ(bvh.dropped(), 2u);
    const auto hits = closest(device, bvh, {{{0.25f, 0.5f, 1}, 0, {0, 0, -1}, 9}, {{-0.25f, 0.5f, 1}, 0, {0, 0, -1}, 9}, {{-0.25f, 0.5f, -3}, 0, {0, 0, 1}, 9},
                                            {{-0.25f, 0.5f, -0.5f}, 0, {0, 0, 1}, 9}});
    EXPECT_EQ(hits[0].t, 1);
    EXPECT_EQ(hits[1].t, 2);
    EXPECT_EQ(hits[2].t, 2);
    EXPECT_EQ(hits[3].triangle, ~0u);
    EXPECT_LT(hits[0].triangle, 2u);
}

// A copy counts where what it copies is not: two sides of a leaf, say, that are textured in different ways.
TEST_F(RaytraceTest, copies_of_cut_outs_are_kept) {
    OpacityScene scene;
    scene.texels = {0x00ffffff, 0xffffffff};
    const TextureRef left{0, 2, 1, wrap_clamp | wrap_clamp << 2, {-1, 0}, {0, 1}, {1, 0}}, right{0, 2, 1, wrap_clamp | wrap_clamp << 2, {1, 0}, {0, 1}, {0, 0}};
    scene.square(0, scene.material({left, 1, 0.5f}));
    scene.square(0, scene.material({right, 1, 0.5f}));
    scene.square(0, scene.material(Opacity::opaque()));
    scene.square(0, scene.material({right, 1, 0.5f}));  // behind what is everywhere: never hit
    const DeviceOpacity opacity(device, scene);
    const Bvh bvh(device, scene.world(), BvhQuality::quick, opacity.reader());
    EXPECT_EQ(bvh.triangles(), 6u);
    const auto hits = closest(device, bvh, {{{-0.5f, 0, 1}, 0, {0, 0, -1}, 9}, {{0.5f, 0, 1}, 0, {0, 0, -1}, 9}});
    EXPECT_EQ(hits[0].triangle / 2, 0u);
    EXPECT_EQ(hits[1].triangle / 2, 1u);
}

TEST_F(RaytraceTest, opaque_scenes_ask_nothing) {
    OpacityScene scene = OpacityScene::soup(50, 1, random);
    for (OpacityMaterial& m : scene.materials) m = Opacity::opaque();
    const Bvh bvh(device, scene.world());
    EXPECT_FALSE(bvh.asks());
    EXPECT_EQ(bvh.constants({{2, 1}}), (engine::Constants{{2, 1}, {trace_asks_constant, 0}, {instanced_constant, 0}}));
}

TEST_F(RaytraceTest, running_out_of_the_loop_budget_is_reported) {
    const Mesh m = soup(2000, 0.3f);
    const Bvh bvh(device, m.world());
    auto rays = on_device(random_rays(64));
    auto status = on_device(std::vector<uint>{0});
    engine::Array<RayHitRecord> hits(device, "test", "hits", 64);
    engine::Program program(device, engine::compute_kernels, "raytrace/closest");
    engine::Recorder recorder(device);
    BvhRef ref = bvh.read(recorder);
    ref.loop_budget = 3;
    recorder.dispatch(program, RayQueryPush{.bvh = ref, .rays = recorder.read(rays), .hits = recorder.write(hits), .status = recorder.write(status), .count = 64}, 64);
    recorder.submit_and_wait();
    EXPECT_EQ(engine::download(device, status)[0], 1u);
}

// Embree itself, in its robust mode, on a height field with boxes on it.
TEST_F(RaytraceTest, agrees_with_embree) {
    Mesh m;
    const int n = 300;
    for (int y = 0; y <= n; ++y) for (int x = 0; x <= n; ++x) m.positions.push_back({x * 0.1f, uniform(0, 0.08f), y * 0.1f});
    for (uint y = 0; y < n; ++y)
        for (uint x = 0; x < n; ++x) {
            const uint a = y * (n + 1) + x, b = a + n + 1;
            m.triangles.push_back({a, b, a + 1, 0}), m.triangles.push_back({a + 1, b, b + 1, 0});
        }
    for (int i = 0; i < 3000; ++i) {
        const vec3 lo(uniform(0, 29), uniform(0, 3), uniform(0, 29));
        m.box(lo, lo + vec3(uniform(), uniform(), uniform()));
    }
    RTCDevice embree = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(embree);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(embree, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, m.positions.size()), m.positions.data(), 12 * m.positions.size());
    auto* indices = static_cast<uvec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, m.triangles.size()));
    for (size_t i = 0; i < m.triangles.size(); ++i) indices[i] = uvec3(m.triangles[i]);
    rtcCommitGeometry(geometry), rtcAttachGeometry(scene, geometry), rtcReleaseGeometry(geometry), rtcCommitScene(scene);

    std::vector<Ray> rays;
    for (int i = 0; i < 100000; ++i) rays.push_back({vec3(15, 2, 15) + in_cube(15), 0, direction(), INFINITY});
    for (auto quality : {BvhQuality::quick, BvhQuality::best}) {
        const Bvh bvh(device, m.world(), quality);
        const auto hits = closest(device, bvh, rays);
        const auto blocked = occluded(device, bvh, rays);
        uint differ = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Ray& r = rays[i];
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            RTCRayHit h{{r.origin.x, r.origin.y, r.origin.z, r.t_min, r.direction.x, r.direction.y, r.direction.z, 0, r.t_max, ~0u, 0, 0}, {}};
            h.hit.geomID = ~0u;
            rtcIntersect1(scene, &context, &h);
            const bool hit = h.hit.geomID != ~0u;
            EXPECT_EQ(blocked[i] != 0, hits[i].triangle != ~0u);
            differ += hit != (hits[i].triangle != ~0u) || (hit && std::abs(hits[i].t - h.ray.tfar) > 1e-4f * h.ray.tfar + 1e-5f);
        }
        // Both are watertight, so they part only at silhouettes, where roundings decide, and where t is ill-conditioned.
        EXPECT_LE(differ, 10u) << "of " << rays.size();
    }
    rtcReleaseScene(scene), rtcReleaseDevice(embree);
}

}  // namespace
}  // namespace myriad::compute
