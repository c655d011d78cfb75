// China and silver.
#include "scenes/builtin/teatime_parts.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes::teatime {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::pi;
using kit::Profile;

// Turns a profile and lets its texture coordinates run from 0 to 1 both ways.
void painted_lathe(Primitive& out, const Profile& profile, int sides, const kit::RadiusFactor& factor = {}) {
    const size_t first = out.texcoords.size();
    kit::lathe(out, profile, sides, factor);
    float length = 0;
    for (size_t i = 1; i < profile.size(); ++i) length += glm::length(profile[i] - profile[i - 1]);
    for (size_t i = first; i < out.texcoords.size(); ++i) out.texcoords[i].y /= length;
}

Profile spun(const std::vector<vec2>& points, float detail) { return kit::spline(points, std::max(2, int(5 * detail + 0.5f))); }

// A round or oval rod along a spline through `points`, as thick at each as `width` says (across, up), ends closed.
void bar(Primitive& out, const std::vector<vec3>& points, const std::vector<vec2>& width, vec3 up, float detail, int sides = 14) {
    const int per_span = std::max(2, int(7 * detail + 0.5f));
    const auto path = kit::spline(points, per_span, false);
    auto scale = kit::spline(width, per_span, false);
    for (vec2& w : scale) w = glm::max(w, vec2(0));
    kit::loft(out, kit::ellipse(1, 1, steps(float(sides), detail)), kit::frames_along(path, up), scale, true);
}

// The lip of a jug: the wall bulges towards +x near the rim.
float lip(float angle, float y, float from, float to, float reach) {
    const float t = glm::smoothstep(from, to, y), toward = std::max(0.0f, std::cos(angle));
    return 1 + t * (reach * std::pow(toward, 8.0f) - 0.06f * (1 - toward));
}

}  // namespace

void teapot(China& out, float detail) {
    const int sides = steps(96, detail);
    // Foot, belly and shoulder; the lid has its own, smaller curve and a knob.
    kit::lathe(out.plain, spun({{0, 0.004f}, {0.038f, 0.004f}, {0.038f, 0.004f}, {0.040f, 0}, {0.040f, 0}, {0.047f, 0}, {0.047f, 0}, {0.048f, 0.005f}, {0.044f, 0.011f}, {0.050f, 0.017f}}, detail), sides);
    painted_lathe(out.painted, spun({{0.050f, 0.017f}, {0.070f, 0.032f}, {0.086f, 0.060f}, {0.089f, 0.082f}, {0.079f, 0.108f}, {0.058f, 0.126f}, {0.046f, 0.132f}}, detail), sides);
    kit::lathe(out.plain, spun({{0.046f, 0.132f}, {0.047f, 0.136f}, {0.044f, 0.139f}, {0.044f, 0.139f}, {0.040f, 0.137f}, {0.040f, 0.137f}, {0.030f, 0.130f}}, detail), sides);
    kit::lathe(out.plain, spun({{0.0385f, 0.135f}, {0.0395f, 0.1385f}, {0.0395f, 0.1385f}, {0.036f, 0.146f}, {0.024f, 0.154f}, {0.010f, 0.158f}, {0.0065f, 0.160f}, {0.006f, 0.164f}, {0.012f, 0.171f},
                                {0.0125f, 0.178f}, {0.006f, 0.184f}, {0, 0.185f}}, detail), sides);
    bar(out.plain, {{0.070f, 0.048f, 0}, {0.100f, 0.058f, 0}, {0.121f, 0.085f, 0}, {0.134f, 0.115f, 0}, {0.158f, 0.138f, 0}},
        {{0.027f, 0.021f}, {0.019f, 0.017f}, {0.0135f, 0.0135f}, {0.0105f, 0.011f}, {0.0105f, 0.0125f}}, {0, 1, 0}, detail, 24);
    bar(out.plain, {{-0.074f, 0.112f, 0}, {-0.105f, 0.124f, 0}, {-0.136f, 0.108f, 0}, {-0.138f, 0.075f, 0}, {-0.116f, 0.047f, 0}, {-0.080f, 0.043f, 0}},
        {{0.0095f, 0.0075f}, {0.008f, 0.0062f}, {0.0078f, 0.0062f}, {0.0078f, 0.0062f}, {0.008f, 0.006f}, {0.0095f, 0.0075f}}, {0, 0, 1}, detail);
    // A thumb rest on the handle.
    bar(out.plain, {{-0.126f, 0.116f, 0}, {-0.134f, 0.124f, 0}, {-0.144f, 0.125f, 0}}, {{0.006f, 0.004f}, {0.006f, 0.004f}, {0.001f, 0.001f}}, {0, 0, 1}, detail, 8);
}

void cup(China& out, float detail) {
    const int sides = steps(64, detail);
    kit::lathe(out.plain, spun({{0, 0.003f}, {0.019f, 0.003f}, {0.019f, 0.003f}, {0.020f, 0}, {0.020f, 0}, {0.024f, 0}, {0.024f, 0}, {0.0245f, 0.004f}, {0.022f, 0.008f}}, detail), sides);
    painted_lathe(out.painted, spun({{0.022f, 0.008f}, {0.029f, 0.014f}, {0.037f, 0.028f}, {0.041f, 0.046f}, {0.045f, 0.060f}}, detail), sides);
    kit::lathe(out.plain, spun({{0.045f, 0.060f}, {0.0448f, 0.0608f}, {0.0440f, 0.0606f}, {0.0432f, 0.0585f}, {0.0393f, 0.046f}, {0.0352f, 0.029f}, {0.027f, 0.016f}, {0.014f, 0.0105f}, {0, 0.010f}}, detail), sides);
    bar(out.plain, {{0.0385f, 0.045f, 0}, {0.052f, 0.052f, 0}, {0.065f, 0.045f, 0}, {0.062f, 0.030f, 0}, {0.050f, 0.019f, 0}, {0.032f, 0.019f, 0}},
        {{0.0045f, 0.003f}, {0.004f, 0.0026f}, {0.0036f, 0.0026f}, {0.0036f, 0.0026f}, {0.004f, 0.0026f}, {0.0045f, 0.003f}}, {0, 0, 1}, detail, 10);
}

void creamer(China& out, float detail) {
    const int sides = steps(72, detail);
    const auto pull = [](float angle, float y) { return lip(angle, y, 0.062f, 0.092f, 0.30f); };
    kit::lathe(out.plain, spun({{0, 0.003f}, {0.022f, 0.003f}, {0.022f, 0.003f}, {0.023f, 0}, {0.023f, 0}, {0.028f, 0}, {0.028f, 0}, {0.028f, 0.004f}, {0.025f, 0.008f}}, detail), sides);
    painted_lathe(out.painted, spun({{0.025f, 0.008f}, {0.036f, 0.018f}, {0.043f, 0.036f}, {0.040f, 0.056f}, {0.034f, 0.070f}, {0.036f, 0.088f}, {0.038f, 0.093f}}, detail), sides, pull);
    kit::lathe(out.plain, spun({{0.038f, 0.093f}, {0.0372f, 0.0938f}, {0.0362f, 0.093f}, {0.0342f, 0.088f}, {0.032f, 0.070f}, {0.038f, 0.056f}, {0.0405f, 0.036f}, {0.034f, 0.020f}, {0.016f, 0.012f}, {0, 0.011f}}, detail), sides, pull);
    bar(out.plain, {{-0.031f, 0.078f, 0}, {-0.052f, 0.088f, 0}, {-0.064f, 0.070f, 0}, {-0.058f, 0.045f, 0}, {-0.038f, 0.030f, 0}},
        {{0.0055f, 0.004f}, {0.0046f, 0.0034f}, {0.0044f, 0.0034f}, {0.0044f, 0.0034f}, {0.0055f, 0.004f}}, {0, 0, 1}, detail, 10);
}

void sugar_bowl(China& out, float detail) {
    const int sides = steps(72, detail);
    kit::lathe(out.plain, spun({{0, 0.003f}, {0.026f, 0.003f}, {0.026f, 0.003f}, {0.027f, 0}, {0.027f, 0}, {0.032f, 0}, {0.032f, 0}, {0.0325f, 0.004f}, {0.030f, 0.009f}}, detail), sides);
    painted_lathe(out.painted, spun({{0.030f, 0.009f}, {0.043f, 0.020f}, {0.050f, 0.038f}, {0.048f, 0.054f}, {0.045f, 0.062f}}, detail), sides);
    kit::lathe(out.plain, spun({{0.045f, 0.062f}, {0.0455f, 0.064f}, {0.0443f, 0.065f}, {0.0428f, 0.063f}, {0.0455f, 0.052f}, {0.047f, 0.038f}, {0.041f, 0.023f}, {0.020f, 0.0125f}, {0, 0.012f}}, detail), sides);
    for (float s : {-1.0f, 1.0f})
        bar(out.plain, {{s * 0.045f, 0.056f, 0}, {s * 0.060f, 0.060f, 0}, {s * 0.066f, 0.047f, 0}, {s * 0.058f, 0.034f, 0}, {s * 0.047f, 0.033f, 0}},
            {{0.0042f, 0.003f}, {0.0038f, 0.0028f}, {0.0036f, 0.0028f}, {0.0038f, 0.0028f}, {0.0042f, 0.003f}}, {0, 0, 1}, detail, 10);
}

void plate(China& out, float radius, float detail) {
    const int sides = steps(72, detail);
    const auto at = [&](std::vector<vec2> points) {
        for (vec2& p : points) p *= radius;
        return spun(points, detail);
    };
    // A rim with a shallow scallop, and a well.
    const auto scallop = [&](float angle, float y) { return 1 + 0.012f * glm::smoothstep(0.10f * radius, 0.18f * radius, y) * std::cos(12 * angle); };
    kit::lathe(out.plain, at({{0, 0.025f}, {0.50f, 0.025f}, {0.50f, 0.025f}, {0.52f, 0}, {0.52f, 0}, {0.57f, 0}, {0.57f, 0}, {0.60f, 0.04f}, {0.80f, 0.115f}, {0.995f, 0.185f}}), sides, scallop);
    painted_lathe(out.painted, at({{0.995f, 0.185f}, {1.0f, 0.192f}, {0.99f, 0.197f}, {0.90f, 0.165f}, {0.70f, 0.105f}}), sides, scallop);
    kit::lathe(out.plain, at({{0.70f, 0.105f}, {0.60f, 0.078f}, {0.54f, 0.060f}, {0.45f, 0.052f}, {0, 0.052f}}), sides);
}

void cake_stand(China& out, float radius, float height, float detail) {
    const int sides = steps(80, detail);
    const float h = height, r = radius;
    kit::lathe(out.plain, spun({{0, 0.004f}, {0.5f * r, 0.004f}, {0.5f * r, 0.004f}, {0.52f * r, 0}, {0.52f * r, 0}, {0.53f * r, 0.005f}, {0.40f * r, 0.018f}, {0.18f * r, 0.026f}, {0.10f * r, 0.04f}, {0.13f * r, 0.5f * h},
                                {0.10f * r, h - 0.035f}, {0.22f * r, h - 0.017f}, {0.6f * r, h - 0.010f}, {0.97f * r, h - 0.007f}}, detail), sides);
    painted_lathe(out.painted, spun({{0.97f * r, h - 0.007f}, {0.985f * r, h - 0.022f}, {0.985f * r, h - 0.022f}, {r, h - 0.022f}, {r, h - 0.022f}, {1.01f * r, h + 0.004f}, {1.0f * r, h + 0.006f}, {0.985f * r, h + 0.004f}, {0.96f * r, h}}, detail), sides,
                  [&](float angle, float y) { return 1 + (y < h - 0.012f ? 0.012f * std::cos(40 * angle) : 0); });
    kit::lathe(out.plain, {{0.96f * r, h}, {0.5f * r, h}, {0, h}}, sides);
}

void tiered_stand(China& china, Primitive& silver, const std::vector<Stand>& tiers, float detail) {
    float top = 0;
    for (const Stand& tier : tiers) {
        China one;
        plate(one, tier.radius, detail);
        kit::append(china.painted, one.painted, glm::translate(mat4(1), vec3(0, tier.height, 0)));
        kit::append(china.plain, one.plain, glm::translate(mat4(1), vec3(0, tier.height, 0)));
        top = std::max(top, tier.height + 0.14f);
    }
    // The rod through them, with a collar at each, and a ring to carry it by.
    std::vector<vec2> rod = {{0, 0.002f}, {0.006f, 0.003f}, {0.006f, 0.003f}};
    for (const Stand& tier : tiers) {
        const float y = tier.height + 0.052f * tier.radius;
        for (vec2 p : {vec2(0.004f, -0.005f), vec2(0.004f, -0.005f), vec2(0.010f, 0.001f), vec2(0.006f, 0.008f), vec2(0.0045f, 0.014f), vec2(0.0045f, 0.014f)}) rod.push_back({p.x, y + p.y});
    }
    rod.insert(rod.end(), {{0.0045f, top - 0.012f}, {0.0045f, top - 0.012f}, {0.009f, top - 0.004f}, {0.005f, top}, {0, top + 0.001f}});
    kit::lathe(silver, spun(rod, detail), steps(18, detail));
    Primitive ring;
    Profile section = kit::ellipse(0.0028f, 0.0028f, steps(10, detail));
    for (vec2& p : section) p.x += 0.022f;
    kit::lathe(ring, section, steps(48, detail));
    kit::append(silver, ring, glm::translate(mat4(1), vec3(0, top + 0.023f, 0)) * glm::rotate(mat4(1), pi / 2, vec3(1, 0, 0)));
}

void liquid(Primitive& out, float radius, float height, float detail) {
    // A meniscus at the wall, and flat.
    kit::lathe(out, {{radius, height + 0.0006f}, {radius - 0.0015f, height}, {0.5f * radius, height - 0.0001f}, {0, height - 0.0001f}}, steps(48, detail));
}

void spoon(Primitive& silver, float detail) {
    // A crescent, hollow above; where it is narrow and flat it is the handle.
    Profile section;
    const int n = steps(10, detail);
    for (int i = 0; i <= n; ++i) {
        const float x = 2 * float(i) / float(n) - 1;
        section.push_back({x, x * x - 1});
    }
    for (int i = 1; i <= n; ++i) {
        const float x = 1 - 2 * float(i) / float(n);
        section.push_back({x, 0.66f * (x * x - 1)});
    }
    const int per_span = std::max(2, int(6 * detail + 0.5f));
    // From the tip of the bowl to the end of the handle, which stands a little up.
    const auto path = kit::spline<vec3>({{-0.022f, 0.0062f, 0}, {-0.012f, 0.0062f, 0}, {0, 0.0062f, 0}, {0.014f, 0.0066f, 0}, {0.022f, 0.0092f, 0}, {0.040f, 0.0135f, 0}, {0.075f, 0.0125f, 0}, {0.105f, 0.0065f, 0}, {0.116f, 0.0052f, 0}}, per_span, false);
    auto scale = kit::spline<vec2>({{0.0006f, 0.0008f}, {0.0100f, 0.0045f}, {0.0128f, 0.0060f}, {0.0085f, 0.0045f}, {0.0026f, 0.0028f}, {0.0021f, 0.0026f}, {0.0030f, 0.0024f}, {0.0056f, 0.0026f}, {0.0010f, 0.0012f}}, per_span, false);
    for (vec2& w : scale) w = glm::max(w, vec2(4e-4f, 6e-4f));
    const auto frames = kit::frames_along(path, {0, 1, 0});
    kit::loft(silver, section, frames, scale, false);
    // No point sees all of a crescent: its ends are closed by what lies between its two curves.
    for (const bool end : {false, true}) {
        const kit::Frame& frame = end ? frames.back() : frames.front();
        const vec2 size = end ? scale.back() : scale.front();
        const vec3 normal = glm::normalize(glm::cross(frame.across, frame.up)) * (end ? 1.0f : -1.0f);
        const uint32_t first = uint32_t(silver.positions.size());
        for (const vec2 p : section) kit::vertex(silver, frame.at + frame.across * (p.x * size.x) + frame.up * (p.y * size.y), normal, p);
        const auto triangle = [&](int a, int b, int c) { kit::triangle(silver, first + uint32_t(a), first + uint32_t(end ? b : c), first + uint32_t(end ? c : b)); };
        for (int i = 0; i < n; ++i) {  // `section` goes right along the lower curve, and back along the upper one
            if (i + 1 < n) triangle(i, i + 1, 2 * n - i - 1);
            if (i > 0) triangle(i, 2 * n - i - 1, 2 * n - i);
        }
    }
}

void cake_knife(Primitive& silver, Primitive& handle, float detail) {
    // A broad blade, 2 mm thick, that narrows to its point, and a round handle.
    const Profile section = {{-1, -0.4f}, {1, -1}, {1, 1}, {-1, 0.4f}, {-1, -0.4f}};
    std::vector<vec3> path;
    std::vector<vec2> scale;
    const int n = steps(20, detail);
    for (int i = 0; i <= n; ++i) {
        const float t = float(i) / float(n);
        path.push_back({-0.15f + 0.15f * t, 0.006f, 0.006f * std::sin(pi * t)});
        scale.emplace_back(0.0005f + 0.022f * std::sqrt(std::min(1.0f, 1.6f * t)) * (1 - 0.7f * glm::smoothstep(0.75f, 1.0f, t)), 0.001f);
    }
    kit::loft(silver, section, kit::frames_along(path, {0, 1, 0}), scale, true);
    bar(handle, {{-0.004f, 0.007f, 0}, {0.02f, 0.008f, 0}, {0.06f, 0.009f, 0}, {0.10f, 0.009f, 0}, {0.115f, 0.009f, 0}}, {{0.006f, 0.005f}, {0.008f, 0.007f}, {0.0075f, 0.0065f}, {0.0095f, 0.008f}, {0.003f, 0.003f}}, {0, 1, 0}, detail, 12);
}

}  // namespace myriad::scenes::teatime
