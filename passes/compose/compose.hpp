// Puts the image together; see README.md.
#pragma once

#include "passes/compose/compose_io.h"
#include "passes/gbuffer/gbuffer.hpp"

namespace myriad::passes {

class ComposePass {
public:
    ComposePass(engine::Device& device, uint32_t width, uint32_t height);

    // Null: the scene has no such light. `irradiance` of VPLs and `natural`, of the environment, have second halves where the G-buffer is glossy.
    void record(engine::Recorder& recorder, const GBuffer& gbuffer, const engine::Array<vec4>* irradiance, const engine::Array<vec4>* natural,
                const engine::Array<vec4>* direct);

    const engine::Array<vec4>& indirect() const { return indirect_; }
    const engine::Array<vec4>& beauty() const { return beauty_; }

private:
    engine::Program compose_;
    engine::Array<vec4> indirect_, beauty_;
};

}  // namespace myriad::passes
