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

// A light that is infinitely far is kept as a VPL as well, for kernels that are told that theirs are (parallel_constant): a part of an
// environment of this solid angle around this direction. Its flux is pi times its irradiance, and falls on what faces it.
MYRIAD_FN Vpl far_light(vec3 to_light, vec3 irradiance, float solid_angle) {
    Vpl light;
    light.position = to_light;   // unit
    light.normal = floatBitsToUint(solid_angle);
    light.flux = pi * irradiance;
    light.bounce = 0u;
    return light;
}
MYRIAD_FN vec3 far_direction(Vpl light) { return light.position; }
MYRIAD_FN float far_solid_angle(Vpl light) { return uintBitsToFloat(light.normal); }

// So is one that shines alike in all directions (gather_omni_constant): its flux is pi times its intensity. Within its radius its light grows no more.
MYRIAD_FN Vpl omni_light(vec3 position, vec3 intensity, float radius) {
    Vpl light;
    light.position = position;
    light.normal = floatBitsToUint(radius);
    light.flux = pi * intensity;
    light.bounce = 0u;
    return light;
}
MYRIAD_FN float omni_radius(Vpl light) { return uintBitsToFloat(light.normal); }

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

// The domain of a punctual light, the unit square that emit_punctual takes, is divided in cells of equal flux, guide_side
// a side, and the guide says how often paths start in each. 32: small beside a window in an outline of some ten metres, and
// a few hundred paths still visit most of them.
const uint guide_side = 32u;
const uint guide_cells = guide_side * guide_side;
const uint guide_floats = guide_side + guide_cells;  // a light: ends of the columns, then of the cells in each column

// What pilot paths met that started in a cell.
struct PilotTally {
    uint first;          // left a VPL where they hit something
    uint second;         // and met something from there that reflects: the VPL lights something
};
MYRIAD_ARRAY(PilotTallies, PilotTally, 4)

// "vpl/pilot": `samples` paths a cell, of two segments each.
struct VplPilotPush {
    GeometryRef geometry;
    BvhRef bvh;
    Lights lights;
    PilotTallies tallies;  // a cell of each punctual light in turn; cleared before
    uint samples;
    uint paths;
    uint seed;
};

// "vpl/emit": starts each path at a light. A path from an emissive triangle leaves a VPL in layer 0; one from a punctual
// light, which has no surface, at the first surface that it hits, in `layer` if there is such a layer.
struct VplEmitPush {
    VplPaths on;
    Lights lights;       // chosen by `cdf`, or where specialisation constant 2 says so, by the guide's
    Floats shares;       // the guide's `cdf`, by light
    Floats cells;        // the guide's: guide_floats a guided light
    uint light_count;
    uint guided_layers;  // lights that the guide has cells of, which are the first << 8 | layers
};

// "vpl/bounce": continues each path from the layer below.
struct VplBouncePush {
    VplPaths on;
};

// A VPL that has died, until another takes its place: it brings no light, faces no receiver, and its view sees nothing.
MYRIAD_FN Vpl vpl_of_nothing() {
    Vpl vpl;
    vpl.position = view_of_nothing().position;
    vpl.normal = pack_direction(view_of_nothing().direction);
    vpl.flux = vec3(0.0f);
    vpl.bounce = 0u;
    return vpl;
}

// "vpl/ask", "vpl/vacate", "vpl/settle": which place each VPL has, so that it has the same one in every frame. The *owner* of a
// place is a slot; it owns the place alive or dead, until one that has none takes a dead one's.
const uint vpl_nobody = 0xffffffffu;
struct VplPlacesPush {
    Vpls slots;
    Uints alive;         // by slot
    Uints flags;         // two a slot, and the sum after the scan: all who are alive and own no place, then all who are dead and own one
    Uints places;        // by slot: its place, if the place's owner says so
    Uints owners;        // by place
    Uints vacant;        // places whose owner is dead, in the order of slots
    Vpls vpls;           // by place
    Views views;         // by place
    Uints count;         // VplPass::count, then count[0] of the frame before
    uint slot_count;
    uint max_vpls;
};
MYRIAD_END

#ifdef __cplusplus
static_assert(sizeof(myriad::Vpl) == 32 && sizeof(myriad::VplPaths) % 8 == 0 && sizeof(myriad::VplEmitPush) <= 128);
static_assert(sizeof(myriad::VplPlacesPush) <= 128);
#endif

#endif
