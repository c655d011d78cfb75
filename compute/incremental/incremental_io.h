// What the kernels that carry cuts from frame to frame and their host share. See README.md.
#ifndef MYRIAD_COMPUTE_INCREMENTAL_IO_H
#define MYRIAD_COMPUTE_INCREMENTAL_IO_H

#include "compute/append/append_io.h"
#include "compute/incremental/slack.h"

MYRIAD_BEGIN
// The carried list holds an item for every block that is open in a view, also where none of its children is in the cut: a group
// (cut_io.h) and its due. Items stay where they are from frame to frame. An item whose block is no longer open leaves a hole.
MYRIAD_FN uvec2 cut_hole() { return uvec2(0xffffffffu, 0xffffu); }  // of no block and no view, with no node-view
MYRIAD_FN bool cut_is_hole(uvec2 code) { return code == cut_hole(); }

// The masks of the root's item in a view that does not exist: culled, and a mark where no slot is.
const uint cut_no_view = 0x300u;

// Where the list ends, and the places that have become free in it.
struct CarriedState {
    uint look;       // what "due" goes through: all of the list, or nothing where nothing stirs
    uint items;      // and holes: the list ends here
    uint holes;      // free.at[0 .. holes)
    uint cut;        // node-views in the cuts of the views that exist
    uint dropped;    // whose owner is no longer open
    uint made;       // blocks newly opened
    uint invalid;    // lazy: node-views in the cut that should be open
};
MYRIAD_ARRAY(CarriedStates, CarriedState, 4)

// The carried list's memory, in one buffer that push constants point to.
struct CarriedRefs {
    Uint2s codes;         // by item
    Dues dues;            // by item
    Uints free;
    Dues found;           // by item of an active list: what the counting pass found, for the writing pass (scan mode)
    Travels travels;      // by view, of this list's
    Views before;         // by view: where it was last frame
    CarriedStates state;
    Uints changed;        // by view: 1 where its cut, or what its cut shows, is not what it was
    Ways ways;            // by block, where bounds move
    uint bounds_now;      // their version where they did since the last frame; 0: they did not
};
MYRIAD_ARRAY(CarriedRefsArray, CarriedRefs, 8)

const uint carry_all = 1u;     // evaluate every item
const uint carry_ways = 2u;    // there are ways
const uint carry_last = 4u;    // lazy: no further step follows; what should be opened stays in the cut

// All kernels but "travel", "restart" and "place".
struct CarryPush {
    AppendRef lists;       // "due": items of the list; "update": (item, 0); "open": (block, view)
    Float4s frames;        // of the tree, as in BshRef
    Uint2s spheres;
    Views views;
    CarriedRefsArray memory;
    uint leaves, blocks;
    float epsilon;
    uint map_size;
    uint first_view;
    uint flags;
};

// "incremental/travel": one invocation a view of the list's; "incremental/restart" as well, before the first frame.
struct TravelPush {
    Views views;
    Uints count;           // of all views
    CarriedRefsArray memory;
    uint first_view, limit;
    uint over_root;        // restart: the block that the root is alone in
    uint flags;            // carry_all
};

// "incremental/shift": one invocation a block of `listed`, or of the tree.
struct ShiftPush {
    Uints listed;
    Float4s frames;        // of the tree, as in BshRef
    Uint2s spheres;
    Float4s frames_before; // as they were in the last frame
    Uint2s spheres_before;
    Ways ways;
    uint count;
    uint all;              // 1: every block, there is no list
    uint first;            // 1: there was no last frame, ways begin
    uint version;          // of the bounds
};

// "incremental/place": one invocation, after "update" (close: 0) and at the end of a frame (1).
struct PlacePush {
    AppendStates lists;
    CarriedRefsArray memory;
    uint capacity;
    uint close;
};
MYRIAD_END

#endif
