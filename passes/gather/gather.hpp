// Irradiance from VPLs; see README.md.
#pragma once

#include <functional>
#include <optional>

#include "compute/append/append.hpp"
#include "compute/raytrace/bvh.hpp"
#include "passes/gather/gather_io.h"
#include "passes/gbuffer/gbuffer.hpp"

namespace myriad::passes {

enum class GatherVisibility { none, maps, rays };

// Pixels in a block's side so that each gathers about `subset` of the lights, 0: all. A power of two: interleaved sets of that many are fair samples of the
// VPL sequence (passes/vpl).
uint32_t gather_block(uint32_t lights, uint32_t subset);

// The VPLs, and how to sum them up.
struct GatherInputs {
    const GBuffer& gbuffer;
    const engine::Array<Vpl>& vpls;
    const engine::Array<uint>& count;  // on the device
    uint32_t block = 1;                // k: each pixel gathers one of k x k sets
    float bound = 1e30f;               // 1/m^2; far lights have none
    const engine::Array<View>* views = nullptr;  // maps of far lights: their views
    const engine::Array<uint>* listed = nullptr; // maps: as GatherPush::listed, where the pass was made for it
    const engine::Array<SharedMap>* asked = nullptr; // maps: by map of the recording, as GatherPush::asked, where the pass was made for it
};

// What a pass is made for.
struct GatherKind {
    bool glossy = false;  // the G-buffer has gloss
    bool far = false;     // the lights are infinitely far, each a far_light() with a parallel view
    bool listed = false;  // maps only: VPLs are not in the order of their sets (GatherInputs::listed)
    bool omni = false;    // lights are omni_light()s
    bool asks = false;    // maps only: they lack what is shared (GatherInputs::asked)
};

class GatherPass {
public:
    GatherPass(engine::Device& device, GatherVisibility visibility, uint32_t width, uint32_t height, const engine::Constants& variant = {}, const GatherKind& kind = {});

    void clear(engine::Recorder& recorder) { recorder.fill(irradiance_, 0); }

    // Adds VPLs [first, first + limit); `first` is a multiple of block * block, so that a VPL's set does not depend on how they are
    // split. Adding them in order gives the same bits however they are split.
    // maps: `atlas` holds the maps of these VPLs. `bias` in texels. `lists`: what the maps were made with; where they overflowed nothing
    // is added, so that the same range can be done again.
    void record_maps(engine::Recorder& recorder, const GatherInputs& in, uint32_t first, uint32_t limit, const engine::Array<uint>* atlas,
                     uint32_t map_size, float bias, const compute::AppendLists* lists = nullptr);
    // rays: `reach` is the scene's largest absolute coordinate.
    void record_rays(engine::Recorder& recorder, const GatherInputs& in, uint32_t first, uint32_t limit, const compute::Bvh& bvh,
                     float reach, const engine::Array<uint>& status);

    // The most VPLs that one recording may take, so that no invocation's loops exceed the device's limit.
    uint32_t max_vpls(uint32_t block) const;

    // W/m^2, rgb, a pixel each; glossy: then as many of radiance that lobes reflect.
    const engine::Array<vec4>& irradiance() const { return irradiance_; }

private:
    uint64_t threads(const GatherInputs& in) const;

    engine::Device& device_;
    GatherVisibility visibility_;
    engine::Program program_;
    engine::Array<vec4> irradiance_;
};

}  // namespace myriad::passes
