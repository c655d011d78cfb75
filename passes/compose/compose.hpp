// Puts the image together; see README.md.
#pragma once

#include "passes/compose/compose_io.h"
#include "passes/gbuffer/gbuffer.hpp"

namespace myriad::passes {

class ComposePass {
public:
    // `lamps`: there are lights that are gathered and whose light is direct.
    ComposePass(engine::Device& device, uint32_t width, uint32_t height, bool lamps = false);

    // Null: the scene has no such light. `irradiance` of VPLs, `natural`, of the environment, and `lamps` have second halves where the G-buffer is glossy;
    // `beyond`, what the VPLs' bound cuts off (passes/compensate), has none.
    void record(engine::Recorder& recorder, const GBuffer& gbuffer, const engine::Array<vec4>* irradiance, const engine::Array<vec4>* natural,
                const engine::Array<vec4>* direct, const engine::Array<vec4>* lamps = nullptr, const engine::Array<vec4>* beyond = nullptr);

    const engine::Array<vec4>& indirect() const { return indirect_; }
    const engine::Array<vec4>& beauty() const { return beauty_; }
    const engine::Array<vec4>* all_direct() const { return all_direct_.count() > 0 ? &all_direct_ : nullptr; }  // null: no lamps

private:
    engine::Program compose_;
    engine::Array<vec4> indirect_, beauty_, all_direct_;
};

}  // namespace myriad::passes
