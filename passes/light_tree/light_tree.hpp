// The tree over views with what their lights send out; see README.md.
#pragma once

#include "compute/append/grid.hpp"
#include "compute/view_tree/view_tree.hpp"
#include "passes/light_tree/light_tree_io.h"

namespace myriad::passes {

class LightTree {
public:
    // For trees of views of this capacity.
    LightTree(engine::Device& device, uint32_t capacity);

    // `views`: built of the views of these lights, hemispheres around their normals, in the lights' order.
    void record(engine::Recorder& recorder, const compute::ViewTree& views, const engine::Array<Vpl>& lights, const engine::Array<uint>& count);

    const engine::Array<Vpl>& lights() const { return ordered_; }       // in the order of the tree's leaves
    const engine::Array<LightNode>& nodes() const { return nodes_; }    // by node; the root is node `capacity`
    uint32_t capacity() const { return uint32_t(ordered_.count()); }

private:
    engine::Program leaves_, merge_;
    compute::Grid grid_;
    engine::Array<Vpl> ordered_;
    engine::Array<LightNode> nodes_;
};

}  // namespace myriad::passes
