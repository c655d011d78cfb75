// MegaViews' part of the maps: a tree over all views, and maps that they share.
#pragma once

#include "compute/megaviews/megaviews.hpp"
#include "passes/fuse/fuse.hpp"
#include "passes/splat/splat.hpp"

namespace myriad::passes {

class SharedMaps {
public:
    // Throws InputError for more views than a view tree holds. `asks`: as FusePass.
    SharedMaps(engine::Device& device, uint32_t max_views, const engine::Constants& constants, bool asks = false);

    // Once a frame: sorts the views, and builds their tree.
    void begin(engine::Recorder& recorder, const engine::Array<View>& views, const engine::Array<uint>& count, const vec3& low, const vec3& high) {
        tree_.record(recorder, views, count, low, high);
    }
    const compute::ViewTree& tree() const { return tree_; }
    // By place along the curve, which views are taken in: which view.
    const engine::Array<uint>& order() const { return tree_.order(); }

    // Draws views [first, first + limit) along the curve into the first `limit` maps of an atlas that holds `maps`; the others are shared ones. Pairs that
    // are rendered are in lists.kept().
    void record(engine::Recorder& recorder, compute::AppendLists& lists, const compute::SceneTree& scene, const engine::Array<uint>& count, uint32_t first, uint32_t limit,
                float epsilon, uint32_t map_size, const engine::Array<uint>& atlas, uint32_t maps);

    const engine::Array<SharedMap>& asked() const { return fuse_.shared_maps(); }  // where it asks

    // After the submission.
    compute::PairReport pairs() const { return megaviews_.report(); }
    uint32_t shared_needed() const { return fuse_.needed(); }

private:
    compute::ViewTree tree_;
    compute::MegaViews megaviews_;
    SplatPass splat_;
    FusePass fuse_;
};

}  // namespace myriad::passes
