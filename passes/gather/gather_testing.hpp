// What the gather's tests share. Tests only.
#pragma once

#include <cmath>

#include "engine/testing.hpp"
#include "passes/gather/gather.hpp"
#include "passes/gather/gather_ref.hpp"

namespace myriad::passes {

class GatherTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }
    vec3 direction() {
        vec3 d = point();
        while (!(dot(d, d) > 0.01f && dot(d, d) < 1)) d = point();
        return normalize(d);
    }

    static Vpl vpl(const vec3& at, const vec3& normal, const vec3& flux) { return {at, pack_direction(normal), flux, 1}; }

    // Receivers anywhere, some of them misses.
    HostGBuffer random_gbuffer(uint32_t width, uint32_t height) {
        HostGBuffer g(width, height);
        for (size_t i = 0; i < g.pixels(); ++i)
            if (random() % 8) g.put(i, point(), direction());
        return g;
    }
    // Lobes for most of its pixels, seen from above the surface or just below.
    void polish(HostGBuffer& g) {
        for (size_t i = 0; i < g.pixels(); ++i) {
            if (!g.hit(i)) continue;
            const float roughness = random() % 5 == 0 ? 0 : random() % 3 ? uniform(0.1f, 1) : brdf_least_roughness;
            g.shine(i, random() % 2 ? vec3(0.04f) : 0.5f * (point() + 1.0f), roughness, normalize(g.shading(i) + 0.99f * direction()));
        }
    }
    std::vector<Vpl> random_vpls(size_t n) {
        std::vector<Vpl> vpls;
        for (size_t i = 0; i < n; ++i) vpls.push_back(vpl(point(1.5f), direction(), 2.0f * (point() + 1.0f)));
        return vpls;
    }

    struct Options {
        uint block = 1;
        float bound = 1e30f;
        std::vector<uint32_t> parts = {};   // VPLs a recording; empty: all in one
        uint32_t beyond = 0;                // how many more than there are the host asks for
        const std::vector<uint>* atlas = nullptr;
        uint map_size = 0;
        float bias = 0;
        const std::vector<uint>* listed = nullptr;  // GatherInputs::listed
        bool omni = false;                       // the lights are omni_light()s
        const std::vector<SharedMap>* asked = nullptr;  // GatherInputs::asked; all in one recording
        const std::vector<View>* far = nullptr;  // the lights are infinitely far, and these their views
    };
    // Maps of depths up to `most`, a fourth of them of nothing.
    std::vector<uint> random_atlas(size_t maps, uint size, float most) {
        std::vector<uint> atlas(maps * map_texels(size));
        for (uint& texel : atlas) texel = floatBitsToUint(random() % 4 ? uniform(0, most) : std::numeric_limits<float>::infinity());
        return atlas;
    }
    static std::vector<uint> exact_atlas(const std::vector<Vpl>& lights, const scenes::Triangles& triangles, uint size) {
        std::vector<uint> atlas;
        for (const Vpl& light : lights) {
            const auto map = exact_map(light.position, triangles, size);
            atlas.insert(atlas.end(), map.begin(), map.end());
        }
        return atlas;
    }

    // None, or maps when there is an atlas.
    std::vector<vec4> run(const HostGBuffer& host, const std::vector<Vpl>& vpls, const Options& o) {
        const GBuffer gbuffer = host.on(device);
        const auto on = on_device(vpls);
        const auto count = on_device(std::vector<uint>{uint(vpls.size())});
        GatherPass gather(device, o.atlas ? GatherVisibility::maps : GatherVisibility::none, host.width, host.height, {},
                          {.glossy = gbuffer.glossy(), .far = o.far != nullptr, .listed = o.listed != nullptr, .omni = o.omni, .asks = o.asked != nullptr});
        const auto views = on_device(o.far ? *o.far : std::vector<View>{view_of_nothing()});
        const auto listed = on_device(o.listed ? *o.listed : std::vector<uint>{0});
        const auto asked = on_device(o.asked ? *o.asked : std::vector<SharedMap>(1));
        const GatherInputs in{gbuffer, on, count, o.block, o.bound, o.far ? &views : nullptr, o.listed ? &listed : nullptr, o.asked ? &asked : nullptr};
        const uint32_t all = uint32_t(vpls.size()) + o.beyond;
        std::vector<uint32_t> parts = o.parts;
        if (parts.empty()) parts = {all};
        engine::Recorder recorder(device);
        gather.clear(recorder);
        for (uint32_t first = 0, i = 0; first < all; first += parts[i++ % parts.size()]) {
            const uint32_t part = parts[i % parts.size()];
            // Maps come batch by batch: this recording's begin with its first VPL's.
            engine::Array<uint> atlas;
            if (o.atlas) {
                const size_t words = map_texels(o.map_size), from = std::min(first, uint32_t(vpls.size())) * words;
                atlas = on_device(std::vector<uint>(o.atlas->begin() + long(from), o.atlas->end()));
            }
            gather.record_maps(recorder, in, first, part, o.atlas ? &atlas : nullptr, o.map_size, o.bias);
            recorder.submit_and_wait();
        }
        recorder.submit_and_wait();
        return engine::download(device, gather.irradiance());
    }

    // The first pixel that is further from its twin than its slack.
    static ::testing::AssertionResult near(const std::vector<GatherRef>& expected, const std::vector<vec4>& got) {
        const size_t n = expected.size();
        if (got.size() != n && got.size() != 2 * n) return ::testing::AssertionFailure() << "sizes differ";
        for (size_t i = 0; i < got.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const GatherRef& e = expected[i % n];
                const double value = i < n ? e.irradiance[c] : e.mirrored[c], slack = i < n ? e.slack[c] : e.mirrored_slack[c];
                if (!(std::abs(value - got[i][c]) <= slack))
                    return ::testing::AssertionFailure() << (i < n ? "irradiance" : "mirrored light") << " of pixel " << i % n << ", channel " << c
                                                         << ": " << value << " +- " << slack << " expected, " << got[i][c] << " found";
            }
        return ::testing::AssertionSuccess();
    }
    // How much of the twin's light is slack: a comparison with much of it would show nothing.
    static double doubt(const std::vector<GatherRef>& expected) {
        double slack = 0, sum = 0;
        for (const GatherRef& r : expected) slack += r.slack.y, sum += r.irradiance.y;
        return slack / sum;
    }
};

}  // namespace myriad::passes
