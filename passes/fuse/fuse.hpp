// Maps that views share, and how they become a map a view; see README.md.
#pragma once

#include <optional>

#include "compute/append/append.hpp"
#include "compute/append/grid.hpp"
#include "compute/scan/scan.hpp"
#include "compute/view_tree/view_tree.hpp"
#include "passes/fuse/fuse_io.h"

namespace myriad::passes {

class FusePass {
public:
    // `asks`: views get no whole maps, look-ups ask what is shared as well.
    FusePass(engine::Device& device, const compute::ViewTree& tree, bool asks = false);

    // After the traversal for views [first, first + limit): a map for each inner view node that something is drawn for, `maps` - `limit` at most; the first `limit` maps are views'.
    // If there are too few the lists fail, and needed() says how many it takes.
    void place(engine::Recorder& recorder, compute::AppendLists& lists, const compute::ViewTree& tree, uint32_t first, uint32_t limit, uint32_t maps);
    // By inner node: which of the maps from `limit` on is its.
    const engine::Array<uint>& places() const { return places_; }

    // After the splat: shared maps, and those of views [first, first + limit), which are the atlas's first ones, get what the maps above have. With `asks` the views'
    // do not, and shared_maps() says which map holds all that each shares.
    void record(engine::Recorder& recorder, const compute::AppendLists& lists, const compute::ViewTree& tree, const engine::Array<uint>& count, uint32_t first,
                uint32_t limit, uint32_t map_size, const engine::Array<uint>& atlas);
    const engine::Array<SharedMap>& shared_maps() const { return shared_maps_; }  // by view from `first`
    // After the submission: maps of inner nodes.
    uint32_t needed() const { return needed_report_.span()[0]; }

private:
    engine::Program reach_, mark_, count_, inherit_, fuse_;
    std::optional<engine::Program> ask_;
    compute::Scan scan_;
    compute::Grid grid_;
    engine::Array<uint> marks_, places_, above_, reached_, inner_nodes_, needed_, needed_report_;
    engine::Array<SharedMap> shared_maps_;
};

}  // namespace myriad::passes
