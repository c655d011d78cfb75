// Linear radiance to 8-bit sRGB; see README.md.
#pragma once

#include "engine/recorder.hpp"
#include "passes/tonemap/tonemap_io.h"

namespace myriad::passes {

class TonemapPass {
public:
    TonemapPass(engine::Device& device, uint64_t pixels);
    void record(engine::Recorder& recorder, const engine::Array<vec4>& radiance, float exposure);
    const engine::Array<uint>& pixels() const { return pixels_; }  // RGBA8, red in the low byte

private:
    engine::Program tonemap_;
    engine::Array<uint> pixels_;
};

}  // namespace myriad::passes
