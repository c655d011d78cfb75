// The plane that a node stands for when it is drawn, and where it is seen edge-on and covers nothing: for the splat, and for who need not hand it such nodes.
#ifndef MYRIAD_COMPUTE_SPLAT_PLANE_H
#define MYRIAD_COMPUTE_SPLAT_PLANE_H

#include "engine/shared.h"

MYRIAD_BEGIN
// A view this near to a node's plane, in radii, sees the node edge-on: it covers nothing. A VPL stands a hair off its own wall, and
// the wall's node, whose normal is good to 1/1400 and whose centre to 1/16384, must not be found in front of it.
const float splat_edge_on = 1.0f / 256.0f;

// The plane of a disc or node of this radius at d, as the view sees it; `faces`: it has no normal to speak of, and faces the view.
struct SplatPlane {
    vec3 normal;
    float height;    // d . normal: how far the view lies off the plane; 0: seen edge-on, covers nothing
};
MYRIAD_FN SplatPlane splat_plane(vec3 d, float radius, vec3 normal, bool faces) {
    SplatPlane p;
    p.normal = normal;
    if (faces) p.normal = d / sqrt(dot(d, d));
    p.height = dot(d, p.normal);
    if (!(abs(p.height) > splat_edge_on * radius)) p.height = 0.0f;
    return p;
}

MYRIAD_END

#endif
