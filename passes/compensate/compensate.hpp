// Gives back the light that the VPLs' bound cuts off, by short rays; see README.md.
#pragma once

#include <optional>

#include "compute/raytrace/bvh.hpp"
#include "passes/compensate/compensate_io.h"
#include "passes/filter/filter.hpp"
#include "passes/geometry/lights.hpp"

namespace myriad::passes {

struct CompensateInputs {
    const GBuffer& gbuffer;
    const Geometry& geometry;
    const compute::Bvh& bvh;
    const LightTable& lights;   // with power
    float bound = 0;            // 1/m^2, above 0: of the geometry term of VPLs that were gathered
    uint32_t bounces = 1;       // as the VPLs have
    uint32_t seed = 1;
};

class CompensatePass {
public:
    // `rays` a pixel, 1 to compensate_most_rays. `variant` says with glossy_constant whether the G-buffer has gloss.
    CompensatePass(engine::Device& device, uint32_t width, uint32_t height, uint32_t rays, bool filter, const engine::Constants& variant);

    // `pixel_angle`: as FilterPass. `exhausted[0]` is set where a ray's walk met the device's limit on loops (trace.glsl): the result cannot be trusted.
    void record(engine::Recorder& recorder, const CompensateInputs& in, float pixel_angle, const engine::Array<uint>& exhausted);

    // rgb: irradiance that the receiver's diffuse part reflects, W/m^2; filtered, if that was asked for.
    const engine::Array<vec4>& irradiance() const { return filter_ ? filter_->filtered() : irradiance_; }

private:
    engine::Program compensate_;
    uint32_t rays_;
    engine::Array<vec4> irradiance_;
    std::optional<FilterPass> filter_;
};

}  // namespace myriad::passes
