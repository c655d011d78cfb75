#include "scenes/builtin/curves.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace myriad::scenes::kit {
namespace {

using glm::vec2;
using glm::vec3;

vec3 any_across(vec3 ahead) {
    const vec3 other = std::abs(ahead.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    return glm::normalize(glm::cross(other, ahead));
}

// The way ahead at each point of a polyline: the mean of the segments that meet there.
std::vector<vec3> directions(const std::vector<vec3>& points) {
    const size_t n = points.size();
    std::vector<vec3> ahead(n);
    for (size_t i = 0; i < n; ++i) ahead[i] = glm::normalize(points[std::min(i + 1, n - 1)] - points[i > 0 ? i - 1 : 0]);
    return ahead;
}

// Carries `across` from one point of a curve to the next by two reflections.
vec3 carried(vec3 across, vec3 from, vec3 to, vec3 ahead, vec3 ahead_next) {
    const vec3 v1 = to - from;
    const float c1 = glm::dot(v1, v1);
    const vec3 across_mirrored = across - v1 * (2 / c1 * glm::dot(v1, across)), ahead_mirrored = ahead - v1 * (2 / c1 * glm::dot(v1, ahead));
    const vec3 v2 = ahead_next - ahead_mirrored;
    const float c2 = glm::dot(v2, v2);
    if (c2 > 0) across = across_mirrored - v2 * (2 / c2 * glm::dot(v2, across_mirrored));
    else across = across_mirrored;
    return glm::normalize(across - ahead_next * glm::dot(across, ahead_next));
}

}  // namespace

template <class V>
std::vector<V> spline(const std::vector<V>& through, int per_span, bool corners) {
    std::vector<V> out = {through.front()};
    // Pieces between corners, each with ends mirrored beyond themselves.
    for (size_t first = 0, last; first + 1 < through.size(); first = last + 1) {
        last = first + 1;
        while (last + 1 < through.size() && !(corners && through[last] == through[last + 1])) ++last;
        const auto p = [&](ptrdiff_t i) {
            const auto lo = ptrdiff_t(first), hi = ptrdiff_t(last);
            if (i < lo) return through[first] * 2.0f - through[first + 1];
            if (i > hi) return through[last] * 2.0f - through[last - 1];
            return through[size_t(i)];
        };
        if (last == first + 1) out.push_back(through[last]);  // straight
        else
            for (auto i = ptrdiff_t(first); i < ptrdiff_t(last); ++i)
                for (int k = 1; k <= per_span; ++k) {
                    const float t = float(k) / float(per_span);
                    const V a = p(i - 1), b = p(i), c = p(i + 1), d = p(i + 2);
                    out.push_back(k == per_span ? c : b + (c - a) * (0.5f * t) + (a - b * 2.5f + c * 2.0f - d * 0.5f) * (t * t) + (b * 1.5f - a * 0.5f - c * 1.5f + d * 0.5f) * (t * t * t));
                }
    }
    return out;
}
template std::vector<vec2> spline(const std::vector<vec2>&, int, bool);
template std::vector<vec3> spline(const std::vector<vec3>&, int, bool);

void tube(Primitive& out, const std::vector<vec3>& points, const std::vector<float>& radii, int sides) {
    const size_t n = points.size();
    assert(n >= 2 && radii.size() == n && sides >= 3);
    const uint32_t ring = uint32_t(sides);
    uint32_t below = none;  // the first vertex of the last ring
    vec3 ahead = glm::normalize(points[1] - points[0]), across = any_across(ahead);

    const auto fan = [&](uint32_t middle, uint32_t first, bool at_start) {
        for (uint32_t k = 0; k < ring; ++k) {
            const uint32_t a = first + k, b = first + (k + 1) % ring;
            if (at_start) triangle(out, middle, b, a);
            else triangle(out, a, b, middle);
        }
    };
    const auto disc = [&](vec3 at, vec3 normal, vec3 up, float radius, float v, bool at_start) {
        const uint32_t first = uint32_t(out.positions.size());
        for (uint32_t k = 0; k < ring; ++k) {
            const float angle = 2 * pi * float(k) / float(sides);
            vertex(out, at + (across * std::cos(angle) + up * std::sin(angle)) * radius, normal, {float(k) / float(sides), v});
        }
        vertex(out, at, normal, {0.5f, v});
        fan(first + ring, first, at_start);
    };

    std::vector<vec2> circle(ring);
    for (uint32_t k = 0; k < ring; ++k) circle[k] = {std::cos(2 * pi * float(k) / float(sides)), std::sin(2 * pi * float(k) / float(sides))};
    for (size_t i = 0; i < n; ++i) {
        const vec3 next = glm::normalize(points[std::min(i + 1, n - 1)] - points[i > 0 ? i - 1 : 0]);
        if (i > 0) across = carried(across, points[i - 1], points[i], ahead, next);
        ahead = next;
        const vec3 up = glm::cross(ahead, across);
        const float v = float(i) / float(n - 1);
        const bool end = i == 0 || i + 1 == n;
        const uint32_t first = uint32_t(out.positions.size());
        if (radii[i] == 0) {
            assert(end && "only an end is a point");
            vertex(out, points[i], i == 0 ? -ahead : ahead, {0.5f, v});
            if (i > 0) fan(first, below, false);
            below = first;
            continue;
        }
        for (uint32_t k = 0; k < ring; ++k) {
            const vec3 normal = across * circle[k].x + up * circle[k].y;
            vertex(out, points[i] + normal * radii[i], normal, {float(k) / float(sides), v});
        }
        if (i > 0 && radii[i - 1] == 0) fan(below, first, true);
        else if (i > 0)
            for (uint32_t k = 0; k < ring; ++k) {
                const uint32_t l = (k + 1) % ring, a = below + k, b = below + l, c = first + k, d = first + l;
                triangle(out, a, b, d);
                triangle(out, a, d, c);
            }
        below = first;
        if (end) disc(points[i], i == 0 ? -ahead : ahead, up, radii[i], v, i == 0);
    }
}

std::vector<Frame> frames_along(const std::vector<vec3>& points, vec3 up) {
    const auto ahead = directions(points);
    std::vector<Frame> frames;
    vec3 across = glm::normalize(glm::cross(up, ahead[0]));
    for (size_t i = 0; i < points.size(); ++i) {
        if (i > 0) across = carried(across, points[i - 1], points[i], ahead[i - 1], ahead[i]);
        frames.push_back({points[i], across, glm::cross(ahead[i], across)});
    }
    return frames;
}

void loft(Primitive& out, const Profile& section, const std::vector<Frame>& frames, const std::vector<vec2>& scale, bool caps) {
    assert(frames.size() >= 2 && scale.size() == frames.size());
    const size_t n = frames.size();
    const auto place = [&](vec2 p, size_t i) { return frames[i].at + frames[i].across * (p.x * scale[i].x) + frames[i].up * (p.y * scale[i].y); };
    float along = 0;
    for (size_t s = 0; s + 1 < section.size(); ++s) {
        const auto tangents = profile_tangents(section, s);
        const float length = glm::length(section[s + 1] - section[s]);
        const uint32_t first = uint32_t(out.positions.size());
        for (size_t i = 0; i < n; ++i)
            for (size_t end = 0; end < 2; ++end) {
                const vec2 p = section[s + end];
                const vec3 dt = place(p, std::min(i + 1, n - 1)) - place(p, i > 0 ? i - 1 : 0);
                // Where the section shrinks to nothing its tangent does too: the direction of its frame is what is left.
                const vec2 size = glm::max(scale[i], vec2(1e-3f) * std::max({scale[i].x, scale[i].y, 1e-6f}));
                const vec3 dp = frames[i].across * (tangents[end].x * size.x) + frames[i].up * (tangents[end].y * size.y);
                const vec3 normal = glm::cross(dp, dt);
                const float size_of = glm::length(normal);
                vertex(out, place(p, i), size_of > 0 ? normal / size_of : frames[i].up, {float(i) / float(n - 1), along + (end ? length : 0)});
            }
        join_grid(out, first, 1, int(n) - 1);
        along += length;
    }
    if (!caps) return;
    vec2 mean(0);
    for (size_t s = 0; s + 1 < section.size(); ++s) mean += section[s] / float(section.size() - 1);
    for (size_t i : {size_t(0), n - 1}) {
        const vec3 normal = glm::normalize(glm::cross(frames[i].across, frames[i].up)) * (i == 0 ? -1.0f : 1.0f);
        const uint32_t first = uint32_t(out.positions.size());
        vertex(out, place(mean, i), normal, {0, 0});
        for (const vec2 p : section) vertex(out, place(p, i), normal, p);
        for (uint32_t s = 1; s < section.size(); ++s) triangle(out, first, first + s + (i == 0), first + s + (i != 0));
    }
}

Profile ellipse(float a, float b, int sides) {
    Profile section;
    for (int i = 0; i <= sides; ++i) {
        const float angle = 2 * pi * float(i % sides) / float(sides);
        section.push_back({a * std::cos(angle), b * std::sin(angle)});
    }
    return section;
}

float Arch::height(float x) const {
    const float d = std::abs(x) + centre(), r = radius();
    return std::sqrt(std::max(0.0f, r * r - d * d));
}

vec2 Arch::at(float t) const {
    const float side = t < 0.5f ? -1.0f : 1.0f, along = 1 - std::abs(2 * t - 1);  // 0 at a springing, 1 at the apex
    if (along == 0) return {side * half, 0};
    if (along == 1) return {0, rise};
    const float angle = along * std::acos(centre() / radius());
    return {side * (radius() * std::cos(angle) - centre()), radius() * std::sin(angle)};
}

void arc_moulding(Primitive& out, const Profile& profile, vec2 centre, float radius, float from, float to, int segments) {
    const bool whole = std::abs(std::abs(from - to) - 2 * pi) < 1e-4f;
    sweep(out, profile, segments, [&](vec2 p, float t) {
        const float angle = from + (to - from) * (whole && t == 1 ? 0 : t);  // a whole circle closes bit by bit
        return vec3(centre + (radius + p.x) * vec2(std::cos(angle), std::sin(angle)), p.y);
    });
}

void arch_moulding(Primitive& out, const Profile& profile, const Arch& arch, float drop, int segments) {
    const float r = arch.radius(), c = arch.centre();
    for (float side : {-1.0f, 1.0f}) {
        const auto up = [&](float t) { return side < 0 ? t : 1 - t; };  // 0 at the foot of this side
        if (drop > 0) sweep(out, profile, 1, [&](vec2 p, float t) { return vec3(side * (arch.half + p.x), drop * (up(t) - 1), p.y); });
        sweep(out, profile, std::max(1, segments / 2), [&](vec2 p, float t) {
            const float radius = r + p.x, angle = up(t) * std::acos(std::clamp(c / radius, -1.0f, 1.0f));
            return vec3(side * (radius * std::cos(angle) - c), radius * std::sin(angle), p.y);
        });
    }
}

void opening_panel(Primitive& out, float width, float height, const Opening& opening, float thickness, int segments) {
    constexpr float cell = 0.8f;
    const Arch& arch = opening.arch;
    const float z = thickness / 2, w = width / 2, a = arch.half, sill = opening.sill, spring = opening.spring;
    const int rows = std::max(2, int(std::lround((height - spring) / cell))), half = std::max(2, segments / 2);
    const int jamb_rows = std::max(1, int(std::lround((spring - sill) / cell)));
    const auto curve = [&](float u) { return arch.at(u) + vec2(0, spring); };

    // Both faces. Each runs left to right as seen from its front: x is mirrored for the back.
    for (float side : {1.0f, -1.0f}) {
        const uint32_t first = uint32_t(out.positions.size());
        for (float start : {0.0f, 0.5f})
            patch(out, half, rows, [&](float u, float v) {
                const vec2 c = curve(start + u / 2);
                return vec3(side * c.x, c.y + (height - c.y) * v, side * z);
            });
        for (float x : {-w, a}) {
            const vec3 corner(side * x, 0, side * z), along(side * (w - a), 0, 0);
            const int n = std::max(1, int(std::lround((w - a) / cell)));
            quad(out, corner + vec3(0, spring, 0), along, {0, height - spring, 0}, n, rows);
            if (spring > sill) quad(out, corner + vec3(0, sill, 0), along, {0, spring - sill, 0}, n, jamb_rows);
        }
        if (sill > 0) quad(out, {-side * w, 0, side * z}, {2 * side * w, 0, 0}, {0, sill, 0}, std::max(1, int(std::lround(width / cell))), std::max(1, int(std::lround(sill / cell))));
        for (uint32_t i = first; i < out.positions.size(); ++i) out.texcoords[i] = {out.positions[i].x, out.positions[i].y};
    }
    // The reveal, seen from the opening.
    const int deep = std::max(1, int(std::lround(thickness / cell)));
    for (float start : {0.0f, 0.5f})
        patch(out, half, deep, [&](float u, float v) {
            const vec2 c = curve(start + u / 2);
            return vec3(c.x, c.y, thickness * v - z);
        }, {arch.radius() * std::acos(arch.centre() / arch.radius()), thickness});
    const vec3 depth(0, 0, thickness);
    if (spring > sill) {
        quad(out, {-a, sill, -z}, {0, spring - sill, 0}, depth, jamb_rows, deep);
        quad(out, {a, sill, -z}, depth, {0, spring - sill, 0}, deep, jamb_rows);
    }
    if (sill > 0) quad(out, {-a, sill, -z}, depth, {2 * a, 0, 0}, deep, 2);
}

void ribbed_vault(Primitive& out, vec2 half, const Arch& arch, int cells) {
    // Eight half cells, each from its boundary arch to a groin, and from the corner to the ridge, where the web is creased.
    // (s, w): distances from the centre as shares of half; in a cell s <= w everywhere and s alone gives the height.
    const float along = arch.radius() * std::acos(arch.centre() / arch.radius());
    for (bool swap : {false, true})
        for (float sx : {-1.0f, 1.0f})
            for (float sz : {-1.0f, 1.0f}) {
                const bool flip = (sx * sz > 0) != swap;  // keeps the front below
                patch(out, cells, std::max(2, cells / 2), [&](float u, float v) {
                    if (flip) u = 1 - u;
                    const float s = arch.at(0.5f * u).x / -arch.half, w = s + (1 - s) * v;
                    const vec2 at = swap ? vec2(w, s) : vec2(s, w);
                    return vec3(sx * at.x * half.x, arch.height(s * arch.half), sz * at.y * half.y);
                }, {along, swap ? half.x : half.y});
            }
}

void polygon_vault(Primitive& out, vec3 a, vec3 b, vec3 centre, const Arch& arch, int cells) {
    const vec3 middle = (a + b) * 0.5f;
    const vec2 size(arch.radius() * std::acos(arch.centre() / arch.radius()), glm::length(centre - middle));
    for (float side : {-1.0f, 1.0f})
        patch(out, cells, std::max(2, cells / 2), [&](float u, float v) {
            if (side < 0) u = 1 - u;  // keeps the front below
            // q: from the centre to the wall; lateral: from the ridge to the side, at most q.
            const float lateral = arch.at(0.5f * u).x / -arch.half, q = lateral + (1 - lateral) * v;
            return centre + (middle - centre) * q + (side > 0 ? b - middle : a - middle) * lateral + vec3(0, arch.height(lateral * arch.half), 0);
        }, size);
}

std::vector<vec3> rib_curve(vec3 springing, vec3 apex, const Arch& arch, int segments) {
    std::vector<vec3> points;
    for (int i = 0; i <= segments; ++i) {
        const vec2 p = arch.at(0.5f * float(i) / float(segments));
        points.push_back(apex + (springing - apex) * (p.x / -arch.half) + vec3(0, p.y, 0));
    }
    return points;
}

}  // namespace myriad::scenes::kit
