// Parallel views: those of lights that are infinitely far, such as an environment is sampled by. Such a view looks along one direction,
// from a rectangle that the scene's bounds are seen in, and all lines of sight are parallel: an orthographic map.
//
// The 32 bytes of a View hold one as well. `position` is the rectangle's corner: with d = x - position, x lies at
//     u = d . across / texel,   v = d . down / texel      in texels, with across and down from parallel_frame(direction),
// at the depth d . direction > 0. `sin_phi` is the length that map_size / 2 texels span, so that the diameter in texels of a sphere's
// footprint is map_size r / sin_phi: it depends on the radius alone. `cos_phi` is -1 - columns, which no cone has. The map is
// the 2 R^2 texels of any other, as so many columns and as many rows as fit: texels are square, and the rectangle's shape is the
// scene's, so that few stay empty.
//
// Nothing is outside of a parallel view: the rectangle holds the whole scene.
#ifndef MYRIAD_COMPUTE_PARALLEL_H
#define MYRIAD_COMPUTE_PARALLEL_H

#include "compute/views/view_io.h"

MYRIAD_BEGIN
// Kernels look at views of one kind, which this specialisation constant says: those of the usual kind do not pay for the other.
const uint parallel_constant = 19u;
MYRIAD_END

#ifdef __cplusplus
namespace myriad {
inline bool is_parallel(const View& view) { return view.cos_phi < -1.0f; }
}  // namespace myriad
#else
layout(constant_id = parallel_constant) const bool parallel_views = false;
bool is_parallel(View view) { return parallel_views; }
#endif

MYRIAD_BEGIN
MYRIAD_FN uint parallel_columns(View view) { return uint(-view.cos_phi) - 1u; }
MYRIAD_FN uint parallel_rows(View view, uint size) { return map_texels(size) / parallel_columns(view); }
// The side of a texel, in metres.
MYRIAD_FN float parallel_texel(View view, uint size) { return 2.0f * view.sin_phi / float(size); }

// Unit vectors perpendicular to the unit vector n and to each other. `across` is horizontal unless n is nearly vertical, so that the
// rectangle around things that stand upright is a tight one.
struct ParallelFrame {
    vec3 across, down;
};
MYRIAD_FN ParallelFrame parallel_frame(vec3 n) {
    const bool upright = abs(n.y) > 0.999f;
    const vec3 side = upright ? vec3(0.0f, -n.z, n.y) : vec3(n.z, 0.0f, -n.x);
    ParallelFrame f;
    f.across = side / sqrt(dot(side, side));
    f.down = cross(f.across, n);
    return f;
}

// Where d = x - position lies, in texels; (0, 0) is the corner of the first texel, whose middle is (0.5, 0.5).
MYRIAD_FN vec2 parallel_place(View view, ParallelFrame frame, vec3 d, uint size) {
    const float scale = 1.0f / parallel_texel(view, size);
    return vec2(dot(d, frame.across) * scale, dot(d, frame.down) * scale);
}

// The texels of an axis with `count` of them whose middles lie within `radius` of `middle`, in texels: first, and one past the last.
MYRIAD_FN uint parallel_first(float middle, float radius, uint count) { return uint(clamp(-floor(0.5f + radius - middle), 0.0f, float(count))); }
MYRIAD_FN uint parallel_end(float middle, float radius, uint count) { return uint(clamp(floor(middle + radius + 0.5f), 0.0f, float(count))); }

// c < epsilon: the diameter of a sphere's footprint, in texels. Decreases with r in floating point, too.
MYRIAD_FN bool parallel_fits(View view, float r, uint size, float epsilon) {
    MYRIAD_PRECISE const float c = float(size) * r / view.sin_phi;
    return c < epsilon;
}
MYRIAD_END

#endif
