// A G-buffer that a test writes itself, pixel by pixel. Tests only.
#pragma once

#include <vector>

#include "engine/transfer.hpp"
#include "passes/brdf/brdf_ref.hpp"
#include "passes/gbuffer/gbuffer.hpp"

namespace myriad::passes {

struct HostGBuffer {
    uint32_t width, height;
    std::vector<vec4> positions, albedo, emitted;
    std::vector<uvec2> normals;
    std::vector<Gloss> gloss;  // empty: all is matte

    // All misses.
    HostGBuffer(uint32_t w, uint32_t h)
        : width(w), height(h), positions(size_t(w) * h, vec4(0)), albedo(positions), emitted(positions), normals(positions.size(), uvec2(0)) {}

    size_t pixels() const { return positions.size(); }
    bool hit(size_t i) const { return positions[i].w != 0; }
    vec3 position(size_t i) const { return vec3(positions[i]); }
    // As kernels see them: packed and unpacked.
    vec3 shading(size_t i) const { return unpack_direction(normals[i].x); }
    vec3 geometric(size_t i) const { return unpack_direction(normals[i].y); }

    void put(size_t i, const vec3& at, const vec3& shading, const vec3& geometric, float depth = 1) {
        positions[i] = vec4(at, depth);
        normals[i] = {pack_direction(shading), pack_direction(geometric)};
    }
    void put(size_t i, const vec3& at, const vec3& normal) { put(i, at, normal, normal); }

    // A glossy surface, where `put` was before. Roughness 0 is a matte one.
    void shine(size_t i, const vec3& f0, float roughness, const vec3& view) {
        gloss.resize(pixels());
        gloss[i] = pack_gloss(f0, roughness, view);
    }
    Lobe lobe(size_t i) const { return gloss.empty() ? matte_lobe() : lobe_of(gloss[i], shading(i)); }
    GlossRef gloss_ref(size_t i) const {
        if (gloss.empty() || is_matte(gloss[i])) return {};
        const Lobe l = lobe(i);
        return {glm::dvec3(l.f0), double(unpack_high(gloss[i].f0_b_roughness))};
    }

    GBuffer on(engine::Device& device) const {
        GBuffer g(device, width, height, !gloss.empty());
        const auto move = [&](const auto& from, const auto& to) { engine::upload_bytes(device, from.data(), to, from.size() * sizeof(from[0])); };
        move(positions, g.positions), move(normals, g.normals), move(albedo, g.albedo), move(emitted, g.emitted), move(gloss, g.gloss);
        return g;
    }
};

}  // namespace myriad::passes
