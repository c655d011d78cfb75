// Cross-bilateral filter of gathered irradiance; see README.md.
#pragma once

#include "passes/filter/filter_io.h"
#include "passes/gbuffer/gbuffer.hpp"

namespace myriad::passes {

class FilterPass {
public:
    // `glossy`: for a G-buffer with gloss, and a gather that made both halves.
    FilterPass(engine::Device& device, uint32_t width, uint32_t height, bool glossy = false);

    // `pixel_angle`: the height of a pixel at distance 1 along the camera's axis.
    void record(engine::Recorder& recorder, const GBuffer& gbuffer, const engine::Array<vec4>& irradiance, uint32_t block, float pixel_angle);

    const engine::Array<vec4>& filtered() const { return filtered_; }

private:
    engine::Program filter_;
    engine::Array<vec4> filtered_;
};

}  // namespace myriad::passes
