// Irradiance from VPLs that tiles of pixels pick out of a tree; see README.md.
#pragma once

#include <limits>
#include <optional>

#include "passes/gather/gather.hpp"
#include "passes/light_tree/light_tree.hpp"
#include "passes/pick/pick_io.h"

namespace myriad::passes {

enum class PickMethod {
    culled,  // evenly, of those that may light the tile at all
    tree,    // by what they may bring
};

constexpr uint32_t pick_block = 4;  // unless there is reason for another

struct PickSettings {
    PickMethod method = PickMethod::tree;
    GatherVisibility visibility = GatherVisibility::maps;
    uint32_t width = 0, height = 0;
    uint32_t vpls = 0;          // there are at most so many: 1 to compute::ViewTree::most_views
    uint32_t picks = 64;        // a pixel: 1 to pick_most
    uint32_t block = pick_block;         // sets of pixels are block x block: 1, 2 or 4
    uint32_t side = 16;         // pixels of a tile: a multiple of `block`
    uint32_t seed = 1;
    bool glossy = false;
    float reach = std::numeric_limits<float>::infinity();  // metres: VPLs further away bring nothing
};

class PickPass {
public:
    // `variant`: as GatherPass.
    PickPass(engine::Device& device, const PickSettings& settings, const engine::Constants& variant = {});

    // Chooses for each tile. `views`: a tree over the views of the VPLs; from here on VPLs are taken in its order. `bound`: 1/m^2, as GatherInputs.
    void record_picks(engine::Recorder& recorder, const GBuffer& gbuffer, const compute::ViewTree& views, const engine::Array<Vpl>& vpls,
                      const engine::Array<uint>& count, float bound);

    // As GatherPass: VPLs [first, first + limit) of the tree's order, whose maps `atlas` holds; null: all are seen. In order, and to the same bits however
    // they are split.
    void record_maps(engine::Recorder& recorder, const GBuffer& gbuffer, uint32_t first, uint32_t limit, const engine::Array<uint>* atlas, uint32_t map_size,
                     float bias, const compute::AppendLists* lists = nullptr);
    void record_rays(engine::Recorder& recorder, const GBuffer& gbuffer, const compute::Bvh& bvh, float reach, const engine::Array<uint>& status);

    void clear(engine::Recorder& recorder) { recorder.fill(irradiance_, 0); }
    const engine::Array<vec4>& irradiance() const { return irradiance_; }  // as GatherPass
    const LightTree& tree() const { return tree_; }
    const engine::Array<PickTile>& tiles() const { return tiles_; }
    const engine::Array<Pick>& picks() const { return picks_; }  // by tile, set, and in ascending order of VPLs
    const PickSettings& settings() const { return settings_; }

private:
    PickShape shape() const { return {settings_.side, settings_.block, settings_.picks, settings_.seed}; }
    uint64_t gather_threads() const { return uint64_t(tile_count_) * pick_sets(settings_.block) * gather_.workgroup_size(); }

    PickSettings settings_;
    float bound_ = 1e30f;
    uint32_t tile_count_, part_, parts_;  // culled: VPLs that an invocation looks at, and how many invocations a tile has
    LightTree tree_;
    engine::Program tiles_kernel_, gather_;
    std::optional<engine::Program> weigh_, sum_, remain_kernel_, pick_;
    engine::Array<PickTile> tiles_;
    engine::Array<Pick> picks_;
    engine::Array<float> weights_;
    engine::Array<uint> remain_;
    engine::Array<vec4> irradiance_;
};

}  // namespace myriad::passes
