// Light of the punctual lights, seen by the camera after one reflection; see README.md.
#pragma once

#include "compute/raytrace/bvh.hpp"
#include "passes/direct/direct_io.h"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/geometry/lights.hpp"

namespace myriad::passes {

class DirectPass {
public:
    // Create one only where it has something to do. Lights that stand for an environment are not its business.
    static bool needed(const LightTable& lights) { return lights.lamps() > 0; }

    // `variant` says with glossy_constant whether the G-buffer has gloss. `lights_a_dispatch`: at most so many are looped over at once; 0: what Device::loop_limit() allows.
    DirectPass(engine::Device& device, uint32_t width, uint32_t height, uint32_t lights_a_dispatch = 0,
               const engine::Constants& variant = {});

    void record(engine::Recorder& recorder, const GBuffer& gbuffer, const compute::Bvh& bvh, const LightTable& lights);

    // [0] != 0: a ray's walk met the device's limit on loops (trace.glsl), and the result cannot be trusted.
    const engine::Array<uint>& exhausted() const { return exhausted_; }
    // rgb: outgoing radiance.
    const engine::Array<vec4>& radiance() const { return radiance_; }

private:
    engine::Program direct_;
    uint32_t lights_a_dispatch_;
    engine::Array<vec4> radiance_;
    engine::Array<uint> exhausted_;
};

}  // namespace myriad::passes
