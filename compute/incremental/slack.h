// How far a view may move until a node-view can change side, so that blocks whose slack is not used up need not be looked at.
//
// classify (manylods_io.h) depends on the view's position p and direction n through two functions of d = c - p, L = |d|:
//     f = frustum distance - cull radius      changes by at most |dp| + |d| |dn|; of a half-space, by at most |n.dp| + |d| |dn|
//     g = |d.x| + t - q r,  t = sqrt(L^2 - r^2)       with q = map size / epsilon; g > 0 where the criterion is below epsilon
// A view that slides along its own surface, as a light path's end does when its light moves, leaves f of half-spaces as it is: most of the floor
// that a VPL lies on is within a node's radius of its horizon. So f has a due of its own. Of g's slack there are two kinds; the longer is kept.
//
// In any direction. In the valid region t is at least r (q^2 - 1) / 2q, so |grad g| <= 1 + L / t <= 2 q^2 / (q^2 - 1).
// In the open region |d.x| + t stays below q r as long as |d.x| + L + 2 |dp| does, or, since t is concave in L, as long as |d.x| + t +
// (1 + L / t) |dp| does. Below q = 2 there is no slack.
//
// In the direction that the view goes. The nodes of a block lie one way from a view, so that their g change alike: by -G.dp, with
// G = (sign u.x, 0, 0) + u and u the direction to the block's owner, packed. Within rho = k t, with l = L / t, a node's t stays above t sqrt(c),
// c = 1 - 2 k l + k^2; its Hessian there has the eigenvalues 1 / t and -r^2 / t^3; and so t differs from -u.dp by at most m |dp| with
// m = |d / t - u| + k / 2 max(c^-1/2, (l^2 - 1) c^-3/2). |d.x| is convex:
// it stays above what G says, less 2 |d.x| for a node on the other side than the owner; it is above that by at most 2 (rho - |d.x|)
// where the view may pass the node. With A the least g of the block's closed nodes, B the least -g of its open ones (the owner is one), so
// lessened, nothing changes side until the view has come rho, or m moved + s has risen by A, or m moved - s by B, with s = G.(p - anchor).
// Most of a view's way is along a block's threshold, or away from it; a slack in any direction has to take all of it for an approach.
//
// Bounds move too: a centre like the view itself; a radius changes f by about |dr|, and g by at most (q + r / t) |dr|, which of a slack takes at
// most (q / 2 + 1) |dr| (t is concave in L and r together). Of A and B they take four times as much, where L / t
// stays below 3 (so that `fits` is about g alone).
//
// Parallel views: g = sin_phi - q r alone, which a radius changes by q |dr|.
//
// What a view has travelled is summed up in three numbers: metres moved, metres pressed (f's part of them), and radians (chords) turned; what the
// nodes of a block have, in two more, metres of centres and of radii. An item is due when one of these has come as far as was noted when it
// was evaluated:
//     pressed + reach turned + ways      f, with |d| <= reach until then
//     moved + ways                       g
//     m moved + 4 ways +- s              g, in the direction that the view goes
// Sums are rounded up, dues down.
#ifndef MYRIAD_COMPUTE_SLACK_H
#define MYRIAD_COMPUTE_SLACK_H

#include "compute/manylods/manylods_io.h"

MYRIAD_BEGIN
// f and g are good to 2^-19 of the lengths they are made of (paraboloid.h).
const float slack_rounding = 1.0f / 262144.0f;

struct Due {
    float frustum;      // negative: at once, moved or not
    float reach;
    float criterion;
    float rise, fall;   // with s, with -s
    uint towards;       // u and m
};
MYRIAD_ARRAY(Dues, Due, 4)

const uint travel_exists = 1u;
const uint travel_moved = 2u;   // this frame
const uint travel_jumped = 4u;  // this frame, in a way that no slack covers: it came, went, has another frustum, or went or turned so far that little is left
const uint travel_late = 8u;    // lazy: something of it waits since the last frame
const uint travel_waits = 16u;  // ... and for the next one
struct Travel {
    float moved, pressed, turned;
    uint flags;
    vec3 anchor;  // where it was when sums began
    vec3 come;    // from there
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
        t.pressed = 0.0f;
        t.turned = 0.0f;
        t.anchor = now.position;
        t.come = vec3(0.0f);
        return t;
    }
    if (now.position == before.position && now.direction == before.direction) return t;
    t.flags |= travel_moved;
    t.come = now.position - t.anchor;
    // Squares that underflow, and what sums and roots round off.
    const float length = moved * (1.0f + slack_rounding) + 1e-18f;
    t.moved = next_up(t.moved + length);
    // The cull radius moves along with the view as it does with a node.
    const bool half_space = before.cos_phi == 0.0f;
    t.pressed = next_up(t.pressed + (1.0f / 1024.0f) * length + (half_space ? abs(dot(before.direction, dp)) * (1.0f + slack_rounding) : length));
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
MYRIAD_FN float travelled_frustum(Travel t, float reach, float way) {
    MYRIAD_PRECISE const float sum = t.pressed + reach * t.turned + way;
    return sum;
}
MYRIAD_FN float travelled_criterion(Travel t, float way) {
    MYRIAD_PRECISE const float sum = t.moved + way;
    return sum;
}

// The direction of d, eight bits a coordinate, and above it m, in hundredths.
MYRIAD_FN uint pack_towards(vec3 d) {
    const float most = max(abs(d.x), max(abs(d.y), abs(d.z)));
    if (!(most > 1e-30f && most < 1e30f)) return 0u;
    vec3 u = d * (1.0f / most);
    u = u * (127.0f / sqrt(dot(u, u))) + vec3(128.5f);
    return uint(u.x) | (uint(u.y) << 8) | (uint(u.z) << 16);
}
MYRIAD_FN vec3 unpack_towards(uint code) {
    return (vec3(float(code & 0xffu), float((code >> 8) & 0xffu), float((code >> 16) & 0xffu)) - vec3(128.0f)) * (1.0f / 127.0f);
}
const float deviation_unit = 0.01f;

// What is known of the slack of a block's nodes and their owner in a view. Metres.
struct Slack {
    float frustum;   // of f; not positive: any movement may change it
    float any;       // of g, in any direction
    float closed;    // A
    float open;      // B
    float passed;    // B where the view may pass nodes, but for 2 rho
    float deviation; // most |d / t - u|
    float tangent;   // least t; 0 where g has no slack by direction
    float stretch;   // most L / t
    float reach;     // most |d|
    uint towards;    // u
};
MYRIAD_FN Slack slack_begin(vec3 towards) {
    Slack s;
    s.frustum = 1e30f;
    s.any = 1e30f;
    s.closed = 1e30f;
    s.open = 1e30f;
    s.passed = 1e30f;
    s.deviation = 0.0f;
    s.tangent = 1e30f;
    s.stretch = 1.0f;
    s.reach = 0.0f;
    s.towards = pack_towards(towards);
    return s;
}

// A node more; u is unpack_towards(s.towards). Without branches but for kinds of views: on devices that mask lanes each would blend all of s.
MYRIAD_FN Slack slack_with(Slack s, vec3 u, View view, vec3 d, float r, uint height, uint where, float q) {
    if (is_parallel(view)) {  // nothing is culled, and what is open depends on radii alone: sin_phi > q r where the node fits
        s.tangent = 0.0f;
        s.reach = 1e30f;
        if (height != 0u) s.any = min(s.any, (abs(view.sin_phi - q * r) - slack_rounding * (view.sin_phi + q * r)) * (0.5f + 1.0f / q));
        return s;
    }
    const float reach = reach_of(d, r);
    const float distance = sqrt(dot(d, d));
    s.reach = max(s.reach, distance);
    const bool all_round = view.cos_phi < 0.0f && view.sin_phi == 0.0f;  // nothing is ever culled
    // The cull radius moves along with a node a little: less than 2^-10 of its way.
    const float border = (abs(frustum_distance(view, d) - cull_radius(d, r, height)) - slack_rounding * reach) * (1.0f - 1.0f / 1024.0f);
    s.frustum = min(s.frustum, all_round ? 1e30f : border);

    const bool is_drawn = where == node_view_drawn && height != 0u;
    const bool is_open = where == node_view_open && height != 0u;
    const bool counts = is_drawn || is_open;
    const float tangent = sqrt(max(distance * distance - r * r, 0.0f));
    const float inverse = 1.0f / tangent;
    const float x = abs(d.x);
    const float over = x + tangent - q * r;
    const float margin = slack_rounding * (reach + q * r);
    const float below = 4.0f * tangent > distance ? -over * tangent / (tangent + distance) : 0.0f;
    const float free = is_drawn ? over * (0.5f - 0.5f / (q * q)) : max(0.5f * (q * r - x - distance), below);
    s.any = min(s.any, counts ? (q < 2.0f ? 0.0f : free) - margin : 1e30f);

    const bool beside = (d.x < 0.0f) == (u.x < 0.0f);  // on the owner's side
    s.closed = min(s.closed, is_drawn ? over - margin - (beside ? 0.0f : 2.0f * x) : 1e30f);
    s.open = min(s.open, is_open ? -over - margin : 1e30f);
    s.passed = min(s.passed, is_open ? -over - margin + (beside ? 2.0f * x : 0.0f) : 1e30f);
    const vec3 apart = d * inverse - u;
    s.deviation = max(s.deviation, counts ? sqrt(dot(apart, apart)) : 0.0f);
    s.tangent = min(s.tangent, counts ? tangent : 1e30f);
    s.stretch = max(s.stretch, counts ? distance * inverse : 1.0f);
    return s;
}

// s: how far the view has come along G.
MYRIAD_FN float along(Travel t, uint towards) {
    const vec3 u = unpack_towards(towards);
    MYRIAD_PRECISE const float sum = (u.x < 0.0f ? u.x - 1.0f : u.x + 1.0f) * t.come.x + u.y * t.come.y + u.z * t.come.z;
    return sum;
}
// m moved + 4 ways: |grad g| <= 1 + L / t <= 4 within rho, and a radius changes g by less than q + L / t
MYRIAD_FN float astray(Travel t, uint towards, float way) {
    MYRIAD_PRECISE const float sum = deviation_unit * float(towards >> 24) * t.moved + 4.0f * way;
    return sum;
}

// When a sum that is `now` has come `free` metres further.
MYRIAD_FN float due_at(float now, float free) { return max(now, now + free - (now + abs(free)) * slack_rounding); }

// When an item is due.
MYRIAD_FN Due due_after(Travel t, float way, Slack slack) {
    Due due;
    due.towards = slack.towards;
    due.rise = 1e30f;
    due.fall = 1e30f;
    float free = slack.any;
    const float least = min(slack.closed, slack.open);
    // Less far where s will soon have come far enough: the sooner, the less a node bends.
    const float rho = min(min(0.25f * slack.tangent, max(2.5f * least, 0.0625f * slack.tangent)), 0.5f * slack.passed - 0.25f * least);
    const float k = rho / slack.tangent;
    const float c = max(1.0f - 2.0f * k * slack.stretch + k * k, 0.0f);
    if (least > 0.0f && rho > free && slack.stretch + k < 3.0f * sqrt(c)) {  // L / t stays below 3
        const float bend = 0.5f * k * max(1.0f / sqrt(c), (slack.stretch * slack.stretch - 1.0f) / (c * sqrt(c)));
        const float m = (slack.deviation + bend) / deviation_unit + 2.0f;  // 2: rounded up, and what tangents are good to
        if (m < 256.0f) {
            free = rho;
            due.towards |= uint(m) << 24;
            const float s = along(t, due.towards);
            const float sum = astray(t, due.towards, way);
            const float doubt = slack_rounding * (4.0f * (abs(t.come.x) + abs(t.come.y) + abs(t.come.z) + rho) + sum);
            due.rise = sum + s + slack.closed * (1.0f - slack_rounding) - doubt;
            due.fall = sum - s + min(slack.open, slack.passed - 2.0f * rho) * (1.0f - slack_rounding) - doubt;
        }
    }
    free = min(free, slack.reach);  // so that |d| stays within twice that, also where all is culled
    due.criterion = due_at(travelled_criterion(t, way), free);
    due.reach = (slack.reach + max(free, 0.0f)) * (1.0f + slack_rounding);
    due.frustum = due_at(travelled_frustum(t, due.reach, way), slack.frustum);
    return due;
}
// Asked where the view or a node has moved, or something waits: at rest, an item without slack would be due for nothing.
MYRIAD_FN bool is_due(Due due, Travel t, float way) {
    if ((t.flags & travel_jumped) != 0u || due.frustum < 0.0f) return true;
    if (!(travelled_frustum(t, due.reach, way) < due.frustum && travelled_criterion(t, way) < due.criterion)) return true;
    const float s = along(t, due.towards);
    const float sum = astray(t, due.towards, way);
    return !(sum + s < due.rise && sum - s < due.fall);
}
MYRIAD_END

#endif
