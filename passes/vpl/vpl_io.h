// What the VPL kernels, their host and the VPLs' readers share.
#ifndef MYRIAD_PASSES_VPL_IO_H
#define MYRIAD_PASSES_VPL_IO_H

#include "compute/common/packing.h"
#include "compute/views/view_io.h"
#include "passes/geometry/geometry_io.h"
#include "passes/geometry/light_io.h"

MYRIAD_BEGIN
// A virtual point light sends flux / pi * cos W/sr into the hemisphere around its normal. 32 bytes, two loads.
struct Vpl {
    vec3 position;       // off the surface, by the rule of ray origins
    uint normal;         // pack_direction of the geometric normal, on the lit side
    vec3 flux;           // W
    uint bounce;         // reflections so far: 0 on an emitter itself, 1 where its light falls first
};
MYRIAD_ARRAY(Vpls, Vpl, 16)

const uint vpl_max_bounces = 64u;

// What all path kernels need. Slot `layer * paths + path` is for the VPL that a path leaves at its `layer`-th vertex.
struct VplPaths {
    GeometryRef geometry;
    BvhRef bvh;
    Vpls slots;
    Uints alive;         // by slot: 1 where a VPL is; cleared before
    Uints exhausted;     // exhausted.at[0] = 1: a walk ran out of its loop budget
    uint paths;
    uint path_bits;      // 2^path_bits >= paths
    uint seed;
    uint layer;          // that the kernel leaves VPLs in
};

// "vpl/emit": starts each path at a light. A path from an emissive triangle leaves a VPL in layer 0; one from a punctual
// light, which has no surface, at the first surface that it hits, in `layer` if there is such a layer.
struct VplEmitPush {
    VplPaths on;
    Lights lights;
    uint light_count;
    uint layers;
};

// "vpl/bounce": continues each path from the layer below.
struct VplBouncePush {
    VplPaths on;
};

// "vpl/compact": moves what is alive to the front, in the order of slots, and makes each VPL's view.
struct VplCompactPush {
    Vpls slots;
    Uints offsets;       // `alive` after the scan: a slot is alive where the next offset differs
    Vpls vpls;
    Views views;
    Uints count;
    uint slot_count;
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::Vpl) == 32 && sizeof(myriad::VplPaths) % 8 == 0 && sizeof(myriad::VplEmitPush) <= 128);
#endif

#endif
