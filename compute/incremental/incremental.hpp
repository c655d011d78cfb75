// Cuts that are carried from frame to frame (ManyLoDs 3.2 and 3.3); see README.md.
#pragma once

#include "compute/manylods/manylods.hpp"
#include "compute/incremental/incremental_io.h"

namespace myriad::compute {

// How far the nodes of a tree's blocks have come, frame after frame: what refits cost carried cuts. For trees that move; it keeps their spheres
// of the frame before. 144 bytes a block read, 80 written where it changed.
class BoundsTravel {
public:
    explicit BoundsTravel(engine::Device& device, uint arity = bsh_arity_default);

    // In every frame, before the cuts that are carried through this tree. Records nothing where the tree was not refitted.
    void record(engine::Recorder& recorder, const Bsh& tree);
    // For a tree that was built anew: sums begin again.
    void restart() { seen_ = since_ = 0; }

    const engine::Array<Way>& ways() const { return ways_; }
    // The version of the bounds at which the sums began; 0: they have not.
    uint64_t since() const { return since_; }

private:
    engine::Device& device_;
    engine::Program shift_;
    uint64_t since_ = 0, seen_ = 0;  // versions of the bounds
    engine::Array<vec4> frames_;
    engine::Array<uvec2> spheres_;
    engine::Array<Way> ways_;
};

// What a frame did to a carried cut; read after the submission.
struct CarryReport {
    AppendReport lists;                    // `processed` counts node-views evaluated, a block's and its owner an item, `kept` is the length of the list
    uint64_t cut = 0;                      // node-views in the cuts, culled ones included
    uint64_t due = 0, dropped = 0, made = 0, holes = 0;  // items
    uint64_t changed = 0;                  // views of which the frame shows something else than the last
    uint64_t invalid = 0;                  // node-views of the cut that should be open (lazy)
    uint64_t items() const { return lists.kept - holes; }
};

struct CarrySettings {
    bool everything = false;  // evaluate every item, as the paper does, not only those that are due
    uint32_t edges = 0;       // lazy: q, the most edges that a node-view goes down in a frame; 0: as many as it takes
};

// The cuts of a range of views. In a frame of incremental updates they are the basic cuts as a set, whatever they were before.
class CarriedCut {
public:
    // Room for `capacity` open blocks, at least one a view. Views [first_view, first_view + views) of those that exist. `constants`: as ManyLods.
    CarriedCut(engine::Device& device, AppendMode mode, uint64_t capacity, uint32_t first_view, uint32_t views, const engine::Constants& constants = {});

    // Forgets the cut: the next frame starts from the roots, and is not lazy. For a tree that was built anew.
    void restart() { started_ = false; }

    // Brings the cut up to date. `in` names the same tree, range of views, epsilon and map size in every frame. After a frame whose lists
    // are not ok() the cut is void: it takes a longer list. `bounds`, if any, must have been recorded in this frame before; where it does not
    // reach back to the last frame, a tree that was refitted makes every item due.
    void record(engine::Recorder& recorder, const ManyLodsInputs& in, const CarrySettings& settings, const BoundsTravel* bounds = nullptr);

    // The cut for those who draw it: its kept list holds the groups, and holes that draw nothing.
    const AppendLists& lists() const { return lists_; }
    // By view of the list's: 0 where the cut, and all that its nodes show, is what it was in the frame before.
    const engine::Array<uint>& changed() const { return changed_; }
    CarryReport report() const;

    static uint64_t bytes(const engine::Device& device, AppendMode mode, uint64_t capacity, uint32_t views);

private:
    Ref<CarriedRefs> memory(engine::Recorder& recorder, const BoundsTravel* bounds);

    uint arity_;
    uint32_t first_view_, views_;
    bool started_ = false;
    uint64_t bounds_version_ = 0;  // that the cut was brought up to date with
    uint bounds_now_ = 0;          // CarriedRefs::bounds_now
    AppendLists lists_;
    engine::Program restart_, travel_, place_;
    AppendKernel due_kernel_, update_, open_;
    engine::Array<Due> dues_, found_;
    engine::Array<uint> free_, state_words_, report_;
    engine::Array<Travel> travels_;
    engine::Array<View> before_;
    engine::Array<uint> changed_, changed_report_;
    engine::Array<CarriedRefs> refs_;
};

}  // namespace myriad::compute
