#include "scenes/builtin/cathedral_parts.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes::cathedral {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::arc;
using kit::pi;
using kit::Profile;
using kit::moved;
using kit::turned;

// A round shaft about (x, z) = axis from y0 to y1, with an attic base and a bell capital of height `cap` (0: without). Only
// the part that stands out around the direction `facing` is made, `spread` to both sides of it.
struct Shaft {
    vec2 axis;
    float radius, y0, y1, cap, facing = 0, spread = pi;
    std::vector<float> rings;  // heights of shaft rings
};

// A leaf that climbs the bell of a capital and curls over under the abacus.
void crocket(Primitive& out, const Shaft& s, float lip, float angle, float width, float detail) {
    const float y = s.y1 - s.cap, r = s.radius, h = s.cap;
    const std::vector<vec2> path = kit::spline<vec2>({{r + 0.01f, y + 0.10f * h}, {r + 0.15f * (lip - r) + 0.015f, y + 0.42f * h}, {r + 0.55f * (lip - r) + 0.02f, y + 0.66f * h},
                                                      {lip + 0.02f, y + 0.76f * h}, {lip + 0.055f, y + 0.70f * h}, {lip + 0.035f, y + 0.61f * h}}, std::max(1, int(detail + 0.5f)));
    const vec3 out_of(std::cos(angle), 0, std::sin(angle));
    std::vector<vec3> points;
    std::vector<vec2> scale;
    for (size_t i = 0; i < path.size(); ++i) {
        points.push_back(vec3(s.axis.x, 0, s.axis.y) + out_of * path[i].x + vec3(0, path[i].y, 0));
        const float t = float(i) / float(path.size() - 1);
        scale.emplace_back(width * (0.55f + 0.45f * std::sin(pi * std::min(1.0f, 0.2f + t))), 0.012f + 0.008f * t * t);
    }
    kit::loft(out, kit::ellipse(1, 1, steps(5, detail)), kit::frames_along(points, out_of), scale, true);
}

void shaft(Primitive& out, const Shaft& s, int leaves, float detail) {
    const float r = s.radius, lip = r + 0.30f * s.cap, yc = s.y1 - s.cap, b = std::min(r, 0.16f);
    Profile profile;
    arc(profile, {r + 0.25f * b, s.y0 + 0.26f * b}, 0.26f * b, -pi / 2, pi / 2, 4);
    arc(profile, {r + 0.34f * b, s.y0 + 0.68f * b}, 0.16f * b, 1.5f * pi, pi, 2);
    arc(profile, {r + 0.10f * b, s.y0 + 0.98f * b}, 0.14f * b, -pi / 2, pi / 2, 3);
    profile.push_back({r, s.y0 + 1.16f * b});
    for (float y : s.rings) {
        profile.push_back({r, y - 0.5f * b});
        arc(profile, {r + 0.04f * b, y - 0.2f * b}, 0.2f * b, -pi / 2, pi / 2, 3);
        arc(profile, {r + 0.04f * b, y + 0.2f * b}, 0.2f * b, -pi / 2 + 0.01f, pi / 2, 3);
        profile.push_back({r, y + 0.5f * b});
    }
    if (s.cap == 0) {
        profile.push_back({r, s.y1});
    } else {
        profile.push_back({r, yc - 0.2f * b});
        arc(profile, {r, yc}, 0.17f * b, -pi / 2, pi / 2, 3);
        for (int i = 0; i <= 6; ++i) {  // the bell: slow, then flaring out
            const float t = float(i) / 6;
            profile.push_back({r + (lip - r) * t * t * t, yc + 0.06f * s.cap + 0.72f * s.cap * std::sin(t * pi / 2)});
        }
        for (vec2 p : {vec2(lip + 0.03f, 0.20f), vec2(lip + 0.05f, 0.16f), vec2(lip + 0.05f, 0.06f), vec2(lip + 0.02f, 0.01f)}) profile.push_back({p.x, s.y1 - p.y * s.cap});
        profile.push_back({0.3f * r, s.y1});
    }
    kit::lathe(out, profile, steps(17 * s.spread / pi, detail), s.axis, s.facing - s.spread, s.facing + s.spread);
    for (int i = 0; i < leaves; ++i) {
        const float angle = s.facing + s.spread * (leaves == 1 ? 0 : s.spread >= pi ? 2 * float(i) / float(leaves) : 1.7f * float(i) / float(leaves - 1) - 0.85f);
        crocket(out, s, lip, angle, 0.24f * std::min(0.35f, pi * r / float(leaves)) + 0.03f, detail);
    }
}

// An octagonal block, for plinths and abaci.
void octagon(Primitive& out, vec2 axis, float radius, float y0, float y1) {
    Profile plan;
    for (int i = 0; i <= 8; ++i) {
        const float angle = 2 * pi * (float(i % 8) + 0.5f) / 8;
        plan.push_back({std::cos(angle) * radius, std::sin(angle) * radius});
    }
    kit::loft(out, plan, kit::frames_along({{axis.x, y0, axis.y}, {axis.x, y1, axis.y}}, {0, 0, 1}), {vec2(1), vec2(1)}, true);
}

// Mouldings that go along an arch: see arch_moulding().
Profile roll(float offset, float z, float radius, int sides) {
    Profile profile = kit::ellipse(radius, radius, sides);
    for (vec2& p : profile) p += vec2(offset, z);
    return profile;
}

Profile hood(float offset, float z) {
    return {{offset + 0.13f, z - 0.02f}, {offset + 0.13f, z + 0.05f}, {offset + 0.09f, z + 0.10f}, {offset + 0.05f, z + 0.08f}, {offset + 0.03f, z + 0.03f}, {offset, z - 0.02f}};
}

// What stands out of a wall of face z by `out` metres between y0 and y1, rounded below and sloped above.
Profile string_course(float z, float y0, float y1, float out) {
    const float h = y1 - y0;
    return {{z - 0.05f, y0}, {z + 0.25f * out, y0 + 0.05f * h}, {z + 0.40f * out, y0 + 0.25f * h}, {z + 0.85f * out, y0 + 0.40f * h},
            {z + out, y0 + 0.55f * h}, {z + 0.92f * out, y0 + 0.72f * h}, {z - 0.05f, y1}};
}

// `n` small arches on shafts before a wall of face z, from y0 to the springing at y1; x centred.
void blind_arcade(Stone& out, int n, float pitch, const Arch& arch, float y0, float y1, float z, bool free_standing, float detail) {
    const int segments = steps(12, detail);
    const float r = 0.045f;
    for (int i = 0; i < n; ++i) {
        const mat4 at = moved({(float(i) - float(n - 1) / 2) * pitch, y1, 0});
        Primitive mouldings;
        kit::arch_moulding(mouldings, roll(0.06f, z + 0.03f, 0.055f, steps(8, detail)), arch, 0, segments);
        kit::arch_moulding(mouldings, roll(-0.02f, z - 0.03f, 0.035f, steps(6, detail)), arch, 0, segments);
        kit::append(out.plain, mouldings, at);
    }
    for (int i = 0; i <= n; ++i) {
        const float x = (float(i) - float(n) / 2) * pitch;
        shaft(out.dark, {{x, z + 0.02f}, r, y0, y1, 0.2f, pi / 2, free_standing ? pi : 0.62f * pi, {}}, 0, detail * 0.6f);
        kit::box(out.plain, {x - 0.13f, y1 - 0.015f, z - 0.12f}, {x + 0.13f, y1 + 0.045f, z + 0.13f}, 1);
    }
}

void finish_web(Primitive& web) {
    for (vec2& uv : web.texcoords) uv = vec2(uv.y, uv.x);  // courses run along the ridges
}

// The section of a rib, hanging from the web; counter-clockwise in (across, up).
Profile rib_section(float w, float h) {
    return {{0, -h}, {0.30f * w, -0.93f * h}, {0.42f * w, -0.76f * h}, {0.30f * w, -0.62f * h}, {0.55f * w, -0.50f * h}, {w, -0.40f * h}, {w, 0.06f},
            {-w, 0.06f}, {-w, -0.40f * h}, {-0.55f * w, -0.50f * h}, {-0.30f * w, -0.62f * h}, {-0.42f * w, -0.76f * h}, {-0.30f * w, -0.93f * h}, {0, -h}};
}

void rib(Primitive& out, vec3 springing, vec3 apex, const Arch& arch, float w, float h, float detail) {
    const auto points = kit::rib_curve(springing, apex, arch, steps(18, detail));
    kit::loft(out, rib_section(w, h), kit::frames_along(points, springing - apex), std::vector<vec2>(points.size(), vec2(1)), false);
}

void boss(Primitive& out, vec3 at, float size, float detail) {
    Primitive one;
    const Profile profile = kit::spline<vec2>({{0, -0.36f}, {0.14f, -0.33f}, {0.16f, -0.28f}, {0.27f, -0.26f}, {0.30f, -0.16f}, {0.20f, -0.04f}, {0.10f, 0.02f}}, 3);
    kit::lathe(one, profile, steps(32, detail), [](float angle, float y) { return 1 + 0.16f * glm::smoothstep(-0.33f, -0.2f, y) * std::cos(8 * angle); });
    kit::append(out, one, moved(at) * glm::scale(mat4(1), vec3(size)));
}

}  // namespace

void append(Stone& out, const Stone& in, const mat4& to) {
    kit::append(out.wall, in.wall, to);
    kit::append(out.plain, in.plain, to);
    kit::append(out.dark, in.dark, to);
    kit::append(out.gilt, in.gilt, to);
}

void course(Primitive& out, const Profile& profile, float half, int segments) {
    kit::sweep(out, profile, segments, [&](vec2 p, float t) { return vec3(half - 2 * half * t, p.y, p.x); });
}

void wall_shafts(Stone& out, float y0, float y1, float detail) {
    for (auto [x, z, r] : {std::tuple(0.0f, 0.12f, 0.12f), {-0.20f, 0.06f, 0.085f}, {0.20f, 0.06f, 0.085f}}) {
        std::vector<float> rings;
        for (float y = triforium; y < y1 - 1; y += clerestory - triforium) rings.push_back(y + 0.1f);
        shaft(out.dark, {{x, z}, r, y0, y1 - 0.06f, 0.5f, pi / 2, 0.62f * pi, rings}, x == 0 ? 3 : 2, detail);
    }
    kit::box(out.plain, {-0.42f, y1 - 0.08f, -0.1f}, {0.42f, y1, 0.44f}, 1);
}

void pier(Stone& out, float detail) {
    const float spring = pier_spring - 0.1f;
    octagon(out.plain, {0, 0}, 1.02f, -0.02f, 0.28f);
    octagon(out.plain, {0, 0}, 0.92f, 0.26f, 0.46f);
    shaft(out.plain, {{0, 0}, 0.44f, 0.45f, spring, 0.62f, 0, pi, {}}, 8, detail);
    for (int i = 0; i < 8; ++i) {
        const bool major = i % 2 == 0;
        const float angle = pi / 4 * float(i), reach = major ? 0.53f : 0.49f;
        shaft(out.dark, {{reach * std::cos(angle), reach * std::sin(angle)}, major ? 0.165f : 0.10f, 0.45f, spring, 0.62f, angle, 0.72f * pi, {2.6f}}, major ? 5 : 3, detail);
    }
    octagon(out.plain, {0, 0}, 1.03f, spring - 0.02f, pier_spring + 0.01f);  // as wide as the feet of the arches
    Stone high;
    wall_shafts(high, pier_spring, vault_spring, detail);
    append(out, high, moved({0, 0, wall_thick / 2}));
}

void respond(Stone& out, float detail) {
    const float spring = pier_spring - 0.1f;
    kit::box(out.plain, {-0.46f, -0.02f, -0.1f}, {0.46f, 0.42f, 0.46f}, 1);
    for (auto [x, z, r] : {std::tuple(0.0f, 0.18f, 0.16f), {-0.26f, 0.07f, 0.10f}, {0.26f, 0.07f, 0.10f}})
        shaft(out.dark, {{x, z}, r, 0.41f, spring, 0.55f, pi / 2, 0.62f * pi, {2.6f}}, x == 0 ? 4 : 2, detail);
    kit::box(out.plain, {-0.50f, spring - 0.02f, -0.1f}, {0.50f, pier_spring + 0.01f, 0.48f}, 1);
}

void nave_bay(Stone& out, float detail) {
    const int segments = steps(28, detail), round = steps(8, detail);
    const float face = wall_thick / 2, half = bay / 2;
    // The arcade: the wall's arch, with a roll at each edge and a hood towards the nave; and a narrower arch within it.
    Primitive wall, trim;
    kit::opening_panel(wall, bay, triforium - pier_spring + 0.1f, {arcade_arch, 0, 0}, wall_thick, segments);
    for (float z : {face, -face}) kit::arch_moulding(trim, roll(0.03f, z, 0.075f, round), arcade_arch, 0, segments);
    kit::arch_moulding(trim, roll(0.20f, face, 0.05f, round), arcade_arch, 0, segments);
    kit::arch_moulding(trim, hood(0.36f, face), arcade_arch, 0, segments);
    kit::arch_moulding(trim, {{0.05f, 0.25f}, {-0.14f, 0.25f}, {-0.18f, 0.20f}, {-0.15f, 0.15f}, {-0.22f, 0.14f}, {-0.28f, 0.08f}, {-0.28f, -0.08f},
                              {-0.22f, -0.14f}, {-0.15f, -0.15f}, {-0.18f, -0.20f}, {-0.14f, -0.25f}, {0.05f, -0.25f}}, arcade_arch, 0, segments);
    kit::append(out.wall, wall, moved({0, pier_spring, 0}));
    kit::append(out.plain, trim, moved({0, pier_spring, 0}));

    // The triforium: four arches before a passage.
    constexpr float passage = -0.05f, floor_y = triforium + 0.25f, spring = 10.35f, ceiling = 11.42f, pitch = 1.0f;
    constexpr Arch small{0.40f, 0.72f};
    kit::box(out.wall, {-half, triforium, -face}, {half, clerestory + 0.05f, passage}, 1, kit::back | kit::front);
    kit::box(out.wall, {-half, triforium, passage - 0.1f}, {half, floor_y, face}, 1, kit::front | kit::top);
    kit::box(out.wall, {-half, ceiling, passage - 0.1f}, {half, clerestory + 0.05f, face}, 1, kit::front | kit::bottom);
    for (float s : {-1.0f, 1.0f}) {
        const float x = s * (2 * pitch + half) / 2, w = (half - 2 * pitch) / 2 + 0.001f;
        kit::box(out.wall, {x - w, floor_y - 0.02f, passage - 0.1f}, {x + w, ceiling + 0.02f, face}, 1, kit::front | kit::left | kit::right);
    }
    Primitive panel;
    kit::opening_panel(panel, pitch, ceiling + 0.03f - spring, {small, 0, 0}, 0.24f, steps(14, detail));
    for (int i = 0; i < 4; ++i) kit::append(out.wall, panel, moved({(float(i) - 1.5f) * pitch, spring, face - 0.13f}));
    Stone arcade;
    blind_arcade(arcade, 4, pitch, small, floor_y - 0.01f, spring, 0, true, detail);
    append(out, arcade, moved({0, 0, face - 0.12f}));
    for (auto [y, reach] : {std::pair(triforium, 0.16f), std::pair(clerestory, 0.14f)}) course(out.plain, string_course(face, y - 0.08f, y + 0.14f, reach), half, 2);

    // The clerestory: one large window.
    Primitive upper, frame;
    const Opening window{clerestory_window.arch, clerestory_window.sill - clerestory, clerestory_window.spring - clerestory};
    const float drop = window.spring - window.sill;
    kit::opening_panel(upper, bay, wall_top - clerestory, window, wall_thick, segments);
    kit::append(out.wall, upper, moved({0, clerestory, 0}));
    kit::arch_moulding(frame, roll(0.03f, face, 0.07f, round), window.arch, drop, segments);
    kit::arch_moulding(frame, roll(-0.05f, face - 0.22f, 0.06f, round), window.arch, drop, segments);
    kit::arch_moulding(frame, hood(0.16f, face), window.arch, 0, segments);
    kit::append(out.plain, frame, moved({0, clerestory_window.spring, 0}));
}

void aisle_bay(Stone& out, float detail) {
    const int segments = steps(24, detail), round = steps(8, detail);
    const float face = outer_thick / 2, half = bay / 2, drop = aisle_window.spring - aisle_window.sill;
    kit::opening_panel(out.wall, bay, 9.0f, aisle_window, outer_thick, segments);
    Primitive frame;
    kit::arch_moulding(frame, roll(0.03f, face, 0.07f, round), aisle_window.arch, drop, segments);
    kit::arch_moulding(frame, roll(-0.05f, face - 0.22f, 0.06f, round), aisle_window.arch, drop, segments);
    kit::arch_moulding(frame, hood(0.16f, face), aisle_window.arch, 0.3f, segments);
    kit::append(out.plain, frame, moved({0, aisle_window.spring, 0}));
    course(out.plain, string_course(face, 2.06f, 2.26f, 0.14f), half, 2);
    kit::box(out.plain, {-half, -0.02f, face - 0.05f}, {half, 0.44f, face + 0.32f}, 1, kit::front | kit::top);  // a bench
    blind_arcade(out, 4, 0.98f, {0.42f, 0.5f}, 0.43f, 1.38f, face, false, detail);
}

void apse_bay(Stone& out, float width, float thick, float detail) {
    const int segments = steps(24, detail), round = steps(8, detail);
    const float face = thick / 2, drop = apse_window.spring - apse_window.sill;
    kit::opening_panel(out.wall, width, wall_top, apse_window, thick, segments);
    Primitive frame;
    kit::arch_moulding(frame, roll(0.03f, face, 0.07f, round), apse_window.arch, drop, segments);
    kit::arch_moulding(frame, roll(-0.05f, face - 0.2f, 0.055f, round), apse_window.arch, drop, segments);
    kit::append(out.plain, frame, moved({0, apse_window.spring, 0}));
    course(out.plain, string_course(face, 3.34f, 3.54f, 0.14f), width / 2, 1);
    blind_arcade(out, 3, 0.86f, {0.36f, 0.6f}, 0.3f, 2.3f, face, false, detail);
}

void transverse_rib(Primitive& out, float detail) {
    const float e = 0.27f;
    kit::arch_moulding(out, {{0.06f, e}, {-0.12f, e}, {-0.17f, 0.8f * e}, {-0.15f, 0.6f * e}, {-0.22f, 0.55f * e}, {-0.30f, 0.42f * e}, {-0.36f, 0.2f * e}, {-0.37f, 0},
                             {-0.36f, -0.2f * e}, {-0.30f, -0.42f * e}, {-0.22f, -0.55f * e}, {-0.15f, -0.6f * e}, {-0.17f, -0.8f * e}, {-0.12f, -e}, {0.06f, -e}},
                       nave_arch, 0, steps(40, detail));
}

void nave_vault(Stone& out, float detail) {
    const vec2 half(bay / 2, nave_arch.half);
    kit::ribbed_vault(out.wall, half, nave_arch, steps(18, detail));
    finish_web(out.wall);
    for (float sx : {-1.0f, 1.0f})
        for (float sz : {-1.0f, 1.0f}) rib(out.plain, {sx * half.x, 0, sz * half.y}, vec3(0), nave_arch, 0.15f, 0.30f, detail);
    // Ridge ribs, and the wall ribs over the windows.
    for (auto [a, b] : {std::pair(vec3(-half.x, nave_arch.rise, 0), vec3(half.x, nave_arch.rise, 0)), std::pair(vec3(0, nave_arch.rise, -half.y), vec3(0, nave_arch.rise, half.y))})
        kit::loft(out.plain, rib_section(0.09f, 0.15f), kit::frames_along({a, b}, {0, 1, 0}), {vec2(1), vec2(1)}, false);
    for (float sx : {-1.0f, 1.0f})
        for (float sz : {-1.0f, 1.0f}) rib(out.plain, {sx * half.x, 0, sz * (half.y - 0.08f)}, {0, 0, sz * (half.y - 0.08f)}, nave_arch, 0.09f, 0.18f, detail);
    boss(out.gilt, {0, nave_arch.rise, 0}, 1.35f, detail);
}

void aisle_vault(Stone& out, float detail) {
    const vec2 half(bay / 2, aisle_arch.half);
    kit::ribbed_vault(out.wall, half, aisle_arch, steps(14, detail));
    finish_web(out.wall);
    for (float sx : {-1.0f, 1.0f})
        for (float sz : {-1.0f, 1.0f}) rib(out.plain, {sx * half.x, 0, sz * half.y}, vec3(0), aisle_arch, 0.11f, 0.22f, detail);
    for (float sz : {-1.0f, 1.0f}) rib(out.plain, {-half.x, 0, sz * half.y}, {-half.x, 0, 0}, aisle_arch, 0.16f, 0.28f, detail);
    boss(out.gilt, {0, aisle_arch.rise, 0}, 0.9f, detail);
}

void apse_vault(Stone& out, float detail) {
    const auto corner = [](int k) {
        const float angle = pi / 5 * float(k) - pi / 2;
        return vec3(std::cos(angle), 0, std::sin(angle)) * nave_arch.half;
    };
    for (int k = 0; k < 5; ++k) {
        kit::polygon_vault(out.wall, corner(k), corner(k + 1), vec3(0), nave_arch, steps(18, detail));
        const vec3 middle = (corner(k) + corner(k + 1)) * 0.49f;
        for (int end : {k, k + 1}) rib(out.plain, corner(end) * 0.98f, middle, nave_arch, 0.08f, 0.16f, detail);
    }
    finish_web(out.wall);
    for (int k = 1; k < 5; ++k) rib(out.plain, corner(k), vec3(0), nave_arch, 0.15f, 0.30f, detail);
    boss(out.gilt, {0, nave_arch.rise, 0}, 1.6f, detail);
    Stone shafts;
    wall_shafts(shafts, 0.3f, vault_spring, detail);
    for (int k = 0; k < 6; ++k) append(out, shafts, moved(corner(k) * 0.97f + vec3(0, -vault_spring, 0)) * turned(-(36.0f * float(k) - 90) - 90));
}

void west_wall(Stone& out, float half, float detail) {
    constexpr float nave = wall + wall_thick / 2, join = 8.4f;
    constexpr Arch door{1.55f, 2.3f}, rose{rose_radius, rose_radius};
    const int segments = steps(40, detail), round = steps(8, detail);
    const float face = wall_thick / 2;
    Primitive lower, part;
    kit::opening_panel(out.wall, 2 * nave, join, {door, 0, 3.2f}, wall_thick, segments);
    kit::opening_panel(part, 2 * nave, rose_height - join, {rose, 0, 0}, wall_thick, segments);
    kit::append(out.wall, part, moved({0, rose_height, 0}) * glm::scale(mat4(1), vec3(1, -1, 1)));
    kit::opening_panel(lower, 2 * nave, wall_top - rose_height, {rose, 0, 0}, wall_thick, segments);
    kit::append(out.wall, lower, moved({0, rose_height, 0}));
    for (float s : {-1.0f, 1.0f}) kit::box(out.wall, {s < 0 ? -half : nave, 0, -face}, {s < 0 ? -nave : half, 9.0f, face}, 1, kit::front | kit::back);
    // Mouldings around the rose and the door; the doors.
    for (auto [offset, z, r] : {std::tuple(0.03f, face, 0.09f), {-0.06f, face - 0.2f, 0.08f}, {0.28f, face, 0.07f}, {0.42f, face, 0.05f}})
        kit::arc_moulding(out.plain, roll(offset, z, r, round), {0, rose_height}, rose_radius, 2 * pi, 0, 2 * segments);
    Primitive frame;
    for (auto [offset, z] : {std::pair(0.03f, face), {-0.08f, face - 0.16f}, {-0.16f, face - 0.32f}}) kit::arch_moulding(frame, roll(offset, z, 0.075f, round), door, 3.2f, segments);
    kit::arch_moulding(frame, hood(0.2f, face), door, 0, segments);
    kit::append(out.plain, frame, moved({0, 3.2f, 0}));
    course(out.plain, string_course(face, join - 0.1f, join + 0.15f, 0.18f), nave, 4);
}

void pew(Primitive& wood, float length, float detail) {
    const float half = length / 2;
    kit::box(wood, {-0.22f, 0.40f, -half}, {0.20f, 0.45f, half}, 1.2f);
    kit::box(wood, {-0.26f, 0.10f, -half}, {-0.22f, 0.88f, half}, 1.2f, kit::all_faces & ~kit::bottom);
    kit::box(wood, {-0.29f, 0.86f, -half}, {-0.20f, 0.92f, half}, 1.2f);
    // The ends: boards with a rounded head and a knob.
    for (float s : {-1.0f, 1.0f}) {
        Profile plan = {{0.24f, -0.01f}, {0.24f, 0.55f}};
        for (int i = 0; i <= steps(8, detail); ++i) {
            const float angle = pi * float(i) / float(steps(8, detail));
            plan.push_back({-0.02f + 0.26f * std::cos(angle), 0.74f + 0.30f * std::sin(angle)});
        }
        plan.insert(plan.end(), {{-0.30f, -0.01f}, plan.front()});
        const float z = s * half;
        kit::loft(wood, plan, kit::frames_along({{0, 0, z - 0.035f}, {0, 0, z + 0.035f}}, {0, 1, 0}), {vec2(1), vec2(1)}, true);
        Primitive knob;
        kit::lathe(knob, kit::spline<vec2>({{0.03f, 0}, {0.025f, 0.03f}, {0.06f, 0.09f}, {0.035f, 0.16f}, {0, 0.20f}}, 3), steps(12, detail));
        kit::append(wood, knob, moved({-0.02f, 1.03f, z}));
    }
}

void altar(Primitive& stone, Primitive& cloth, Primitive& gold, Primitive& flames, float detail) {
    kit::box(stone, {-0.5f, 0, -1.4f}, {0.5f, 1.0f, 1.4f}, 0.5f, kit::all_faces & ~kit::bottom);
    kit::box(stone, {-0.62f, 0.98f, -1.55f}, {0.62f, 1.10f, 1.55f}, 0.5f);
    // A frontal that hangs from the top edge towards the nave (-x), with shallow folds.
    kit::patch(cloth, steps(60, detail), steps(10, detail), [](float u, float v) {
        return vec3(-0.632f - 0.012f * v * (1 + std::sin(50 * u)), 1.105f - 0.9f * v, -1.5f + 3.0f * u);
    });
    kit::patch(cloth, steps(20, detail), 4, [](float u, float v) { return vec3(0.5f - 1.132f * v, 1.106f, -1.5f + 3.0f * u); });
    Primitive candle, flame;
    kit::lathe(candle, kit::spline<vec2>({{0.10f, 0}, {0.10f, 0.02f}, {0.10f, 0.02f}, {0.03f, 0.05f}, {0.04f, 0.12f}, {0.02f, 0.2f}, {0.03f, 0.38f}, {0.06f, 0.42f}, {0.06f, 0.42f}, {0.018f, 0.43f},
                                          {0.018f, 0.43f}, {0.018f, 0.8f}, {0.018f, 0.8f}, {0, 0.8f}}, 3), steps(14, detail));
    kit::lathe(flame, kit::spline<vec2>({{0, 0}, {0.014f, 0.03f}, {0.009f, 0.06f}, {0, 0.1f}}, 3), steps(8, detail));
    for (int i = 0; i < 6; ++i) {
        const vec3 at(0.35f, 1.1f, (float(i) - 2.5f) * 0.5f + (i < 3 ? -0.12f : 0.12f));
        kit::append(gold, candle, moved(at));
        kit::append(flames, flame, moved(at + vec3(0, 0.81f, 0)));
    }
    // A cross between them.
    kit::box(gold, {0.31f, 1.09f, -0.16f}, {0.43f, 1.15f, 0.16f}, 1);
    kit::box(gold, {0.345f, 1.13f, -0.03f}, {0.395f, 2.25f, 0.03f}, 1);
    kit::box(gold, {0.35f, 1.78f, -0.32f}, {0.39f, 1.84f, 0.32f}, 1);
}

}  // namespace myriad::scenes::cathedral
