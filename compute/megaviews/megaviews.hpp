// MegaViews: the scene's tree and the tree of views, walked together; see README.md.
#pragma once

#include <vector>

#include "compute/append/append.hpp"
#include "compute/bsh/bsh.hpp"
#include "compute/megaviews/megaviews_io.h"
#include "compute/view_tree/view_tree.hpp"

namespace myriad::compute {

struct MegaViewsInputs {
    const SceneTree& tree;
    const ViewTree& views;
    uint32_t first = 0, limit = 0;  // the views along the curve that maps are made for
    float epsilon = 1;              // texels
    uint32_t map_size = 0;          // texels a side of a half map
};

// What became of the pairs, step by step: the more steps, the deeper in either tree.
struct PairReport {
    struct Step {
        uint64_t tested = 0, culled = 0, edge_on = 0, rendered = 0;  // edge-on ones would be rendered, and cover nothing
        uint64_t shared = 0;        // views below the rendered pairs' view nodes, of those that were asked for

        Step& operator+=(const Step& other);
    };
    std::vector<Step> steps;        // until nothing was open
    Step total;
};

class MegaViews {
public:
    // `constants`: bsh_constants, for trees of another arity than the default; svo_constant, for octrees.
    explicit MegaViews(engine::Device& device, const engine::Constants& constants = {});

    // Rendered pairs, as cut groups in lists.kept() whose views are nodes of in.views.
    void record(engine::Recorder& recorder, AppendLists& lists, const MegaViewsInputs& in);
    PairReport report() const;      // after the submission

private:
    uint arity_;
    AppendKernel seed_, open_;
    engine::Array<PairRefs> refs_;
    engine::Array<uint> counts_, counts_report_;
    engine::Array<uint> one_;       // root
};

}  // namespace myriad::compute
