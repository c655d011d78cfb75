// Point lights that have a radius, seen as glowing balls; see README.md.
#pragma once

#include "engine/recorder.hpp"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/glow/glow_io.h"

namespace myriad::passes {

class GlowPass {
public:
    // Create one only where some point light has a radius.
    static bool needed(const LightTable& lights);

    GlowPass(engine::Device& device, uint32_t width, uint32_t height);

    // Adds them to GBuffer::emitted, after the G-buffer.
    void record(engine::Recorder& recorder, const GBuffer& gbuffer, const scenes::Camera& camera, const LightTable& lights);

    // W/(m^2 sr) that a unit of the sums stands for, so that they have room for all balls in one pixel.
    static float unit_of(std::span<const Light> lights);

private:
    engine::Program splat_, resolve_;
    engine::Array<uint> sums_;
};

}  // namespace myriad::passes
