// Draws the cut into the atlas; see README.md.
#pragma once

#include <optional>

#include "compute/append/append.hpp"
#include "compute/append/grid.hpp"
#include "compute/bsh/bsh.hpp"
#include "passes/splat/splat_io.h"

namespace myriad::passes {

struct SplatInputs {
    const compute::AppendLists& cut;     // its kept list
    const compute::SceneTree& tree;
    const engine::Array<View>& views;
    uint32_t first_view = 0, map_size = 0;
    // By view from `first_view`: 0 where the atlas holds this very map already, and keeps it. Null: it holds nothing.
    const engine::Array<uint>* changed = nullptr;
    // Maps that views share: `views` are nodes of a view tree, of which those from `view_capacity` on are inner ones, and this says which of the maps
    // from `first_shared` on each of these has. Null: a map a view.
    const engine::Array<uint>* places = nullptr;
    uint32_t view_capacity = 0, first_shared = 0;
};

class SplatPass {
public:
    // `constants`: as compute::ManyLods; svo_constant, for octrees; shared_maps_constant, where views share maps.
    explicit SplatPass(engine::Device& device, engine::Constants constants = {});

    // Throws InputError when maps of this size cannot be drawn on the device (a driver that limits loops).
    static void check_map_size(const engine::Device& device, uint32_t map_size);

    // Clears `atlas` (map_texels(map_size) words a view, view `first_view` first) and draws the cut into it.
    void record(engine::Recorder& recorder, const SplatInputs& in, const engine::Array<uint>& atlas);

private:
    engine::Device& device_;
    uint32_t threads_per_group_;
    engine::Program splat_;
    std::optional<engine::Program> clear_;  // once maps are kept
    compute::Grid grid_;
};

}  // namespace myriad::passes
