// What tests of the ray tree share: meshes of all kinds, and rays on the device against the twin.
#pragma once

#include "compute/opacity/opacity_testing.hpp"
#include "compute/raytrace/ray_query.hpp"
#include "compute/raytrace/raytrace_ref.hpp"
#include "engine/testing.hpp"

namespace myriad::compute {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;

    WorldTriangles world() const { return {positions, triangles}; }
    void triangle(vec3 a, vec3 b, vec3 c) {
        const uint n = uint(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({n, n + 1, n + 2, 0});
    }
    // An axis-aligned box whose faces share vertices and look outward.
    void box(vec3 lo, vec3 hi) {
        const uint n = uint(positions.size());
        for (uint i = 0; i < 8; ++i) positions.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
        for (auto [a, b, c, d] : {std::array{0u, 4u, 6u, 2u}, {1u, 3u, 7u, 5u}, {0u, 1u, 5u, 4u}, {2u, 6u, 7u, 3u}, {0u, 2u, 3u, 1u}, {4u, 5u, 7u, 6u}}) {
            triangles.push_back({n + a, n + b, n + c, 0});
            triangles.push_back({n + a, n + c, n + d, 0});
        }
    }
    // A closed sphere of 2 * rings * segments or so triangles, normals outward.
    static Mesh sphere(uint rings, uint segments, float radius, vec3 centre) {
        Mesh m;
        m.positions.push_back(centre + vec3(0, 0, radius));
        for (uint r = 1; r < rings; ++r)
            for (uint s = 0; s < segments; ++s) {
                const double a = M_PI * r / rings, b = 2 * M_PI * s / segments;
                m.positions.push_back(centre + radius * vec3(sin(a) * cos(b), sin(a) * sin(b), cos(a)));
            }
        m.positions.push_back(centre - vec3(0, 0, radius));
        auto at = [&](uint r, uint s) { return r == 0 ? 0 : r == rings ? uint(m.positions.size() - 1) : 1 + (r - 1) * segments + s % segments; };
        for (uint r = 0; r < rings; ++r)
            for (uint s = 0; s < segments; ++s) {
                if (r > 0) m.triangles.push_back({at(r, s), at(r + 1, s), at(r, s + 1), 0});
                if (r + 1 < rings) m.triangles.push_back({at(r + 1, s), at(r + 1, s + 1), at(r, s + 1), 0});
            }
        return m;
    }
};

class RaytraceTest : public engine::DeviceTest {
protected:
    float uniform(float lo = 0, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 in_cube(float r = 1) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
    vec3 direction() {
        for (;;)
            if (const vec3 d = in_cube(); dot(d, d) > 0.01f && dot(d, d) < 1) return normalize(d);
    }
    Mesh soup(uint n, float size) {
        Mesh m;
        for (uint i = 0; i < n; ++i) {
            const vec3 c = in_cube();
            m.triangle(c + size * in_cube(), c + size * in_cube(), c + size * in_cube());
        }
        return m;
    }
    std::vector<Ray> random_rays(uint n, float cube = 1.2f) {
        std::vector<Ray> rays;
        for (uint i = 0; i < n; ++i) rays.push_back({in_cube(cube), i % 3 ? 0 : 0.3f, i % 5 ? direction() : 2.0f * direction(), i % 4 ? INFINITY : 0.7f});
        return rays;
    }

    // record(query, recorder, rays, answers, status) asks.
    template <class T, class Record>
    std::vector<T> answers(engine::Device& on, const Bvh& bvh, const std::vector<Ray>& rays, Record record) {
        RayQuery query(on, bvh);
        const auto list = engine::upload(on, "test", "rays", rays);
        const auto status = engine::upload(on, "test", "status", std::vector<uint>{0});
        engine::Array<T> result(on, "test", "answers", rays.size());
        engine::Recorder recorder(on);
        record(query, recorder, list, result, status);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(on, status)[0], 0u);
        return engine::download(on, result);
    }
    std::vector<RayHitRecord> closest(engine::Device& on, const Bvh& bvh, const std::vector<Ray>& rays) {
        return answers<RayHitRecord>(on, bvh, rays, [&](RayQuery& query, auto& recorder, auto& list, auto& result, auto& status) {
            query.closest(recorder, bvh, list, result, status);
        });
    }
    std::vector<uint> occluded(engine::Device& on, const Bvh& bvh, const std::vector<Ray>& rays) {
        return answers<uint>(on, bvh, rays, [&](RayQuery& query, auto& recorder, auto& list, auto& result, auto& status) {
            query.occluded(recorder, bvh, list, result, status);
        });
    }
    std::vector<RayHitRecord> closest(const Mesh& m, const std::vector<Ray>& rays) { return closest(device, Bvh(device, m.world()), rays); }
    std::vector<uint> occluded(const Mesh& m, const std::vector<Ray>& rays) { return occluded(device, Bvh(device, m.world()), rays); }

    // Device against the float twin, to the bit, closest and occluded.
    void agree(engine::Device& on, const Mesh& m, const std::vector<Ray>& rays, BvhQuality quality = BvhQuality::quick) {
        agree(on, m.world(), m.world(), rays, quality);
    }
    // `written_out`: the same scene without instances.
    void agree(engine::Device& on, const WorldTriangles& world, const WorldTriangles& written_out, const std::vector<Ray>& rays, BvhQuality quality,
               const OpacityReader& opacity = {}) {
        agree(on, Bvh(on, world, quality, opacity), written_out, rays);
    }
    void agree(engine::Device& on, const Bvh& bvh, const WorldTriangles& written_out, const std::vector<Ray>& rays) {
        const BvhData all = build_bvh(written_out);
        const auto hits = closest(on, bvh, rays);
        const auto blocked = occluded(on, bvh, rays);
        uint wrong = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const RayHitRecord expected = closest_ref(all.triangles, rays[i], written_out);
            if (std::memcmp(&expected, &hits[i], sizeof expected) == 0 && blocked[i] == uint(expected.triangle != ~0u)) continue;
            if (++wrong == 1)
                ADD_FAILURE() << "ray " << i << " of " << rays.size() << ": expected triangle " << expected.triangle << " at " << expected.t << " ("
                              << expected.u << ", " << expected.v << "), found " << hits[i].triangle << " at " << hits[i].t << " (" << hits[i].u
                              << ", " << hits[i].v << "), occluded " << blocked[i];
        }
        EXPECT_EQ(wrong, 0u) << "of " << rays.size();
    }
    void agree(const Mesh& m, const std::vector<Ray>& rays) { agree(device, m, rays); }

    // Rays from inside a closed mesh at its vertices, edge midpoints and random points; none may escape.
    void watertight(const Mesh& m, vec3 inside, float jitter, uint n_random) {
        std::vector<Ray> rays;
        auto shoot = [&](vec3 target) {
            const vec3 from = inside + in_cube(jitter);
            rays.push_back({from, 0, target - from, INFINITY});
        };
        for (vec3 p : m.positions) for (int k = 0; k < 3; ++k) shoot(p);
        for (uvec4 t : m.triangles)
            for (int k = 0; k < 3; ++k) shoot(0.5f * (m.positions[t[k]] + m.positions[t[(k + 1) % 3]]));
        for (uint i = 0; i < n_random; ++i) rays.push_back({inside + in_cube(jitter), 0, direction(), INFINITY});
        const auto hits = closest(m, rays);
        const auto blocked = occluded(m, rays);
        uint escaped = 0, inward = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            escaped += hits[i].triangle == ~0u || !blocked[i];
            inward += hits[i].front;
        }
        EXPECT_EQ(escaped, 0u) << "of " << rays.size();
        EXPECT_LE(inward, rays.size() / 1000) << "seen from inside, faces show their backs";
    }
};

}  // namespace myriad::compute
