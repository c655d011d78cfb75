// ManyLoDs: the cuts of many views through one BSH, in parallel; see README.md.
#pragma once

#include "compute/append/append.hpp"
#include "compute/bsh/bsh.hpp"
#include "compute/manylods/manylods_io.h"

namespace myriad::compute {

struct ManyLodsInputs {
    const Bsh& tree;
    const engine::Array<View>& views;
    const engine::Array<uint>& view_count;  // on the device
    uint32_t first_view = 0, limit = 0;     // the views to cut: at most `limit` from `first_view` on
    float epsilon = 1;                      // texels
    uint32_t map_size = 0;                  // texels a side of a half map
};

class ManyLods {
public:
    // `constants`: parallel_constant, for parallel views; bsh_constants, for trees of another arity than the default.
    explicit ManyLods(engine::Device& device, const engine::Constants& constants = {});

    // The basic approach (3.1): the cuts, as groups, in lists.kept(). lists.report() tells afterwards whether they fitted;
    // `processed` counts node-views tested. `limit` is at most lists.next_capacity(). A tree without samples has no cut.
    void record(engine::Recorder& recorder, AppendLists& lists, const ManyLodsInputs& in) const;

    // The same cuts by one depth-first walk a view: the rival, for measurements. `state` is an AppendState; its `kept` counts
    // groups, `processed` blocks opened.
    void record_walk(engine::Recorder& recorder, const engine::Array<uvec2>& kept, const engine::Array<uint>& state,
                     const ManyLodsInputs& in) const;

private:
    uint arity_;
    AppendKernel seed_, open_;
    engine::Program walk_;
};

}  // namespace myriad::compute
