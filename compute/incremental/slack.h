// How far a view may move until a node-view can change side, so that blocks whose slack is not used up need not be looked at.
//
// classify (manylods_io.h) depends on the view's position p and direction n through two functions:
//     f = frustum distance - cull radius      changes by at most |dp| + |d| |dn|
//     g = |d.x| + sqrt(L^2 - r^2) - q r       with q = map size / epsilon; g > 0 where the criterion is below epsilon
// In the valid region the tangent's length t = sqrt(L^2 - r^2) is at least r (q^2 - 1) / 2q, so |grad g| <= 1 + L / t <= 2 q^2 / (q^2 - 1).
// In the open region |d.x| + t stays below q r as long as |d.x| + L + 2 |dp| does, or, since t is concave in L, as long as |d.x| + t +
// (1 + L / t) |dp| does. Below q = 2 there is no slack.
//
// Bounds move too: a centre like the view itself; a radius changes f by about |dr|, and g by at most (q + r / t) |dr|, which of a slack takes at
// most (q / 2 + 1) |dr| (t is concave in L and r together).
//
// Parallel views: g = sin_phi - q r alone, which a radius changes by q |dr|.
//
// What a view has travelled is summed up in two numbers, metres moved and radians (chords) turned; what the nodes of a block have, in two
// more, metres of centres and of radii. An item's due is
//     moved + reach turned + ways + slack     at the time it was evaluated, with |d| <= reach until then,
// and it is due when the sum without the slack has come that far. Sums are rounded up, dues down.
#ifndef MYRIAD_COMPUTE_SLACK_H
#define MYRIAD_COMPUTE_SLACK_H

#include "compute/manylods/manylods_io.h"

MYRIAD_BEGIN
// f and g are good to 2^-19 of the lengths they are made of (paraboloid.h).
const float slack_rounding = 1.0f / 262144.0f;

struct Due {
    float at;      // negative: at once, moved or not
    float reach;
};
MYRIAD_ARRAY(Dues, Due, 8)

const uint travel_exists = 1u;
const uint travel_moved = 2u;   // this frame
const uint travel_jumped = 4u;  // this frame, in a way that no slack covers: it came, went, has another frustum, or went or turned so far that little is left
const uint travel_late = 8u;    // lazy: something of it waits since the last frame
const uint travel_waits = 16u;  // ... and for the next one
struct Travel {
    float moved;
    float turned;
    uint flags;
};
MYRIAD_ARRAY(Travels, Travel, 4)

MYRIAD_FN float next_up(float positive) { return uintBitsToFloat(floatBitsToUint(positive) + 1u); }

MYRIAD_FN Travel travel_on(Travel t, View before, bool existed, View now, bool exists) {
    const vec3 dp = now.position - before.position;
    const vec3 dn = now.direction - before.direction;
    const float moved = sqrt(dot(dp, dp));
    const float turned = sqrt(dot(dn, dn));
    t.flags = (exists ? travel_exists : 0u) | ((t.flags & travel_waits) != 0u ? travel_late : 0u);
    if (exists != existed || now.cos_phi != before.cos_phi || now.sin_phi != before.sin_phi || !(moved < 1e12f && turned < 0.5f)) {
        t.flags |= travel_jumped;
        t.moved = 0.0f;  // every item of the view is evaluated now, so sums can begin anew, and stay fine
        t.turned = 0.0f;
        return t;
    }
    if (now.position == before.position && now.direction == before.direction) return t;
    t.flags |= travel_moved;
    // Squares that underflow, and what sums and roots round off.
    t.moved = next_up(t.moved + (moved * (1.0f + slack_rounding) + 1e-18f));
    t.turned = next_up(t.turned + (turned * (1.0f + slack_rounding) + 1e-18f));
    return t;
}

MYRIAD_FN bool travel_stirs(Travel t) { return (t.flags & (travel_moved | travel_jumped | travel_late)) != 0u; }

// Metres that the nodes of a block have come: the most of any centre, and of any radius.
struct Way {
    float centers, radii;
    uint version;  // of the bounds, when they last did or might have
};
MYRIAD_ARRAY(Ways, Way, 4)

// What it takes of a slack.
MYRIAD_FN float way_length(Way w, float q) {
    MYRIAD_PRECISE const float sum = w.centers + (0.5f * q + 1.0f) * w.radii;
    return sum;
}

// A block's nodes go on, at most so far.
MYRIAD_FN Way way_on(Way w, float centers, float radii) {
    if (!(centers + radii > 0.0f)) return w;
    w.centers = next_up(w.centers + (centers * (1.0f + slack_rounding) + 1e-18f));
    w.radii = next_up(w.radii + radii);
    return w;
}

// The same in every kernel, so that an item at rest is exactly where it was. `way`: what its nodes have come.
MYRIAD_FN float travelled(Travel t, float reach, float way) {
    MYRIAD_PRECISE const float sum = t.moved + reach * t.turned + way;
    return sum;
}

// Metres; not positive: any movement may change it. `length` is |d|.
MYRIAD_FN float node_slack(View view, vec3 d, float length, float r, uint height, uint where, float q) {
    if (is_parallel(view)) {  // nothing is culled, and what is open depends on radii alone: sin_phi > q r where the node fits
        if (height == 0u) return 1e30f;
        return (abs(view.sin_phi - q * r) - slack_rounding * (view.sin_phi + q * r)) * (0.5f + 1.0f / q);
    }
    const float reach = reach_of(d, r);
    const bool all_round = view.cos_phi < 0.0f && view.sin_phi == 0.0f;  // nothing is ever culled
    // The cull radius moves along a little: less than 2^-10 of the way.
    float slack = all_round ? 1e30f : (abs(frustum_distance(view, d) - cull_radius(d, r, height)) - slack_rounding * reach) * (1.0f - 1.0f / 1024.0f);
    if (where == node_view_culled || height == 0u) return slack;
    const float tangent = sqrt(max(length * length - r * r, 0.0f));
    const float x = abs(d.x);
    const float over = x + tangent - q * r;
    float free = 0.0f;
    if (where == node_view_drawn) free = over * (0.5f - 0.5f / (q * q));
    else free = max(0.5f * (q * r - x - length), 4.0f * tangent > length ? -over * tangent / (tangent + length) : 0.0f);
    if (q < 2.0f) free = 0.0f;
    return min(slack, free - slack_rounding * (reach + q * r));
}

// When an item of least slack `slack` is due, whose nodes' centres are within `reach`.
MYRIAD_FN Due due_after(Travel t, float way, float slack, float reach) {
    Due due;
    due.reach = (reach + max(slack, 0.0f)) * (1.0f + slack_rounding);
    const float now = travelled(t, due.reach, way);
    due.at = max(now, now + slack - (now + abs(slack)) * slack_rounding);
    return due;
}
// Asked where the view or a node has moved, or something waits: at rest, an item without slack would be due for nothing.
MYRIAD_FN bool is_due(Due due, Travel t, float way) {
    return (t.flags & travel_jumped) != 0u || due.at < 0.0f || !(travelled(t, due.reach, way) < due.at);
}
MYRIAD_END

#endif
