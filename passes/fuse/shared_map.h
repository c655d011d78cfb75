// Where a view finds what it shares with others, and what of it the view sees.
#ifndef MYRIAD_PASSES_SHARED_MAP_H
#define MYRIAD_PASSES_SHARED_MAP_H

#include "engine/shared.h"

MYRIAD_BEGIN
const uint fuse_no_map = 0xffffffffu;

struct SharedMap {
    vec3 offset;    // metres, from the place that the map is seen from to the view
    uint first;     // word of the atlas; fuse_no_map: there is none
};
MYRIAD_ARRAY(SharedMapArray, SharedMap, 16)

// The depth that a texel has in a map at `offset` from the one that shows it at depth t, its middle towards the unit direction w: the surface stays
// where it is, the texel is the same (MegaViews 3.2, "fusion").
MYRIAD_FN float fused_depth(vec3 offset, vec3 w, float t) {
    const vec3 q = t * w - offset;
    return sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
}
MYRIAD_END

#endif
