// Linen, furniture, and the pictures on both.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/builtin/teatime_parts.hpp"

namespace myriad::scenes::teatime {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::pi;
using kit::Profile;
using kit::moved;

Profile spun(const std::vector<vec2>& points, float detail) { return kit::spline(points, std::max(2, int(5 * detail + 0.5f))); }

void rod(Primitive& out, const std::vector<vec3>& through, float radius, float detail) {
    const auto path = kit::spline(through, steps(9, detail));
    kit::tube(out, path, std::vector<float>(path.size(), radius), steps(12, detail));
}

// A raised panel with a frame, on the wall z = 0.
void panel(Primitive& out, vec2 lo, vec2 hi, float frame, float thick) {
    const unsigned faces = kit::all_faces & ~kit::back;
    kit::box(out, {lo.x, lo.y, -0.01f}, {lo.x + frame, hi.y, thick}, 0.4f, faces);
    kit::box(out, {hi.x - frame, lo.y, -0.01f}, {hi.x, hi.y, thick}, 0.4f, faces);
    kit::box(out, {lo.x + 0.5f * frame, lo.y, -0.01f}, {hi.x - 0.5f * frame, lo.y + frame, thick - 0.001f}, 0.4f, faces);
    kit::box(out, {lo.x + 0.5f * frame, hi.y - frame, -0.01f}, {hi.x - 0.5f * frame, hi.y, thick - 0.001f}, 0.4f, faces);
    kit::box(out, {lo.x + 1.7f * frame, lo.y + 1.7f * frame, -0.01f}, {hi.x - 1.7f * frame, hi.y - 1.7f * frame, 0.6f * thick}, 0.4f, faces);
}

}  // namespace

void tablecloth(Primitive& out, float radius, float side, uint32_t seed, float detail) {
    kit::Random random(seed);
    std::array<float, 4> phase;
    for (float& p : phase) p = random.real(0, 2 * pi);
    const float half = side / 2, bend = 0.018f;
    const size_t first = out.texcoords.size();
    // (angle, s): s is the length of cloth from the middle. It lies flat, turns over the table's edge, and falls; what the
    // rim is too short for goes into folds, deeper the further down, deepest at the corners of the square.
    const auto point = [&](float u, float v, vec2& flat) {
        const float angle = 2 * pi * (u == 1 ? 0 : u), reach = half / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
        const float s = v < 0.4f ? radius * v / 0.4f : radius + (reach - radius) * (v - 0.4f) / 0.6f;
        flat = s * vec2(std::cos(angle), std::sin(angle));
        const float over = std::max(0.0f, s - radius), arc = bend * pi / 2, turn = std::min(over / bend, pi / 2);
        const float drop = std::max(0.0f, over - arc);
        const float corner = std::pow(std::abs(std::sin(2 * angle)), 3.0f);
        const float wave = std::sin(13 * angle + phase[0] + 0.7f * std::sin(3 * angle + phase[1])) + 0.35f * std::sin(22 * angle + phase[2]) + 0.45f * std::sin(5 * angle + phase[3]);
        const float depth = glm::smoothstep(0.0f, 0.30f, drop) * (0.020f + 0.055f * drop + 0.02f * corner);
        const float r = std::min(s, radius) + bend * std::sin(turn) + 0.16f * drop * (1 - 0.35f * drop) + depth * wave + 0.012f;
        const float ripple = 0.0009f * std::sin(9 * s + phase[1]) * std::sin(3 * angle + phase[2]) * glm::smoothstep(0.1f, 0.3f, s);
        const float y = -bend * (1 - std::cos(turn)) - drop * (0.985f - 0.03f * wave * depth) + 0.003f + (over > 0 ? 0 : ripple * 0.4f);
        return vec3((over > 0 ? r : s + 0.012f * s / radius) * std::cos(angle), y, (over > 0 ? r : s + 0.012f * s / radius) * std::sin(angle));
    };
    vec2 ignored;
    const int around = steps(280, detail), along = steps(64, detail);
    kit::patch(out, around, along, [&](float u, float v) { return point(u, v, ignored); });
    for (size_t j = 0, i = first; j <= size_t(along); ++j)
        for (size_t k = 0; k <= size_t(around); ++k, ++i) {
            vec2 flat;
            point(float(k) / float(around), float(j) / float(along), flat);
            out.texcoords[i] = 0.5f + flat / side;
        }
}

void napkin(Primitive& out, float side, float detail) {
    // A triangle of four layers, which bulge along the fold and part at the open edges.
    for (int layer = 0; layer < 4; ++layer) {
        const float lift = 0.0018f * float(layer + 1), shrink = 1 - 0.015f * float(layer);
        kit::patch(out, steps(16, detail), steps(16, detail), [&](float u, float v) {
            const float x = (u - 0.5f) * side * (1 - v) * shrink, z = v * side / 2 * shrink;
            const float bulge = 0.006f * std::exp(-60 * v) + 0.004f * v * v * float(layer) * (0.6f + 0.4f * std::sin(9 * u));
            return vec3(x, lift + bulge + 0.0012f * std::sin(30 * u + 2 * float(layer)) * v, -z);
        });
    }
}

void table(Primitive& wood, float radius, float height, float detail) {
    kit::lathe(wood, spun({{0, height - 0.03f}, {radius - 0.02f, height - 0.03f}, {radius - 0.02f, height - 0.03f}, {radius, height - 0.018f}, {radius - 0.004f, height}, {radius - 0.004f, height}, {0, height}}, detail), steps(96, detail));
    kit::lathe(wood, spun({{0.03f, 0.16f}, {0.055f, 0.17f}, {0.06f, 0.21f}, {0.045f, 0.25f}, {0.045f, 0.25f}, {0.05f, 0.26f}, {0.07f, 0.33f}, {0.055f, 0.45f}, {0.035f, 0.55f}, {0.045f, 0.58f}, {0.045f, 0.60f}, {0.05f, 0.64f},
                           {0.12f, height - 0.04f}, {0.12f, height - 0.02f}}, detail), steps(40, detail));
    for (int i = 0; i < 4; ++i) {
        const float angle = pi / 4 + pi / 2 * float(i);
        const vec3 way(std::cos(angle), 0, std::sin(angle));
        const auto path = kit::spline<vec3>({way * 0.03f + vec3(0, 0.23f, 0), way * 0.14f + vec3(0, 0.20f, 0), way * 0.27f + vec3(0, 0.08f, 0), way * 0.36f + vec3(0, 0.022f, 0), way * 0.40f + vec3(0, 0.02f, 0)}, steps(8, detail));
        std::vector<vec2> scale;
        for (size_t k = 0; k < path.size(); ++k) scale.emplace_back(0.024f, 0.032f - 0.012f * float(k) / float(path.size() - 1));
        kit::loft(wood, kit::ellipse(1, 1, steps(12, detail)), kit::frames_along(path, {0, 1, 0}), scale, true);
    }
}

void chair(Primitive& wood, Primitive& cane, float detail) {
    const float seat = 0.46f;
    Profile rim = kit::ellipse(0.022f, 0.018f, steps(14, detail));
    for (vec2& p : rim) p += vec2(0.195f, seat);
    kit::lathe(wood, rim, steps(56, detail));
    kit::lathe(cane, spun({{0.19f, seat - 0.004f}, {0.1f, seat - 0.006f}, {0, seat - 0.007f}}, detail), steps(40, detail));
    kit::lathe(cane, spun({{0, seat - 0.013f}, {0.1f, seat - 0.012f}, {0.19f, seat - 0.010f}}, detail), steps(40, detail));
    for (float s : {-1.0f, 1.0f}) rod(wood, {{s * 0.135f, seat, 0.125f}, {s * 0.155f, 0.25f, 0.155f}, {s * 0.185f, 0, 0.19f}}, 0.0145f, detail);
    // The back legs and the hoop are one rod; a smaller hoop within it.
    rod(wood, {{-0.20f, 0, -0.22f}, {-0.18f, 0.25f, -0.175f}, {-0.165f, seat, -0.145f}, {-0.185f, 0.66f, -0.17f}, {-0.17f, 0.82f, -0.205f}, {-0.09f, 0.91f, -0.225f}, {0, 0.93f, -0.23f}, {0.09f, 0.91f, -0.225f}, {0.17f, 0.82f, -0.205f},
               {0.185f, 0.66f, -0.17f}, {0.165f, seat, -0.145f}, {0.18f, 0.25f, -0.175f}, {0.20f, 0, -0.22f}}, 0.0145f, detail);
    rod(wood, {{-0.09f, seat, -0.17f}, {-0.10f, 0.60f, -0.175f}, {-0.085f, 0.76f, -0.20f}, {0, 0.825f, -0.215f}, {0.085f, 0.76f, -0.20f}, {0.10f, 0.60f, -0.175f}, {0.09f, seat, -0.17f}}, 0.010f, detail);
    Primitive brace;
    Profile ring = kit::ellipse(0.009f, 0.009f, steps(10, detail));
    for (vec2& p : ring) p += vec2(0.20f, 0.20f);
    kit::lathe(brace, ring, steps(56, detail));
    kit::append(wood, brace, moved({0, 0, -0.012f}));
}

void picture_frame(Primitive& gold, Primitive& canvas, float width, float height, float detail) {
    // kit::ring runs around a rectangle in the plane of x and z: it is stood up.
    Primitive frame;
    kit::ring(frame, spun({{0, -0.01f}, {0, 0.010f}, {0, 0.010f}, {-0.012f, 0.016f}, {-0.020f, 0.012f}, {-0.020f, 0.012f}, {-0.034f, 0.026f}, {-0.046f, 0.032f}, {-0.055f, 0.020f}, {-0.055f, 0.020f}, {-0.055f, -0.01f}}, detail), {width / 2, height / 2}, 0.2f);
    kit::append(gold, frame, glm::rotate(mat4(1), pi / 2, vec3(1, 0, 0)));
    kit::quad(canvas, {-width / 2 - 0.01f, -height / 2 - 0.01f, 0.006f}, {width + 0.02f, 0, 0}, {0, height + 0.02f, 0}, 4, 4);
    for (size_t i = canvas.texcoords.size() - 25; i < canvas.texcoords.size(); ++i) canvas.texcoords[i] = {canvas.positions[i].x / width + 0.5f, canvas.positions[i].y / height + 0.5f};
}

void sideboard(Primitive& wood, Primitive& brass, float width, float height, float depth, float detail) {
    const float w = width / 2, front = depth;
    kit::box(wood, {-w, 0.08f, 0.005f}, {w, height - 0.02f, front}, 0.3f);
    kit::box(wood, {-w - 0.03f, height - 0.028f, 0.004f}, {w + 0.03f, height, front + 0.03f}, 0.3f);
    kit::box(wood, {-w + 0.03f, 0, 0.03f}, {w - 0.03f, 0.09f, front - 0.03f}, 0.3f);
    const int doors = 3;
    const float pitch = 2 * w / doors;
    for (int i = 0; i < doors; ++i) {
        Primitive leaf, drawer, knob;
        panel(leaf, {-w + pitch * float(i) + 0.015f, 0.12f}, {-w + pitch * float(i + 1) - 0.015f, height - 0.24f}, 0.05f, 0.022f);
        panel(drawer, {-w + pitch * float(i) + 0.015f, height - 0.21f}, {-w + pitch * float(i + 1) - 0.015f, height - 0.05f}, 0.022f, 0.020f);
        kit::append(wood, leaf, moved({0, 0, front}));
        kit::append(wood, drawer, moved({0, 0, front}));
        kit::lathe(knob, spun({{0.006f, 0}, {0.005f, 0.012f}, {0.014f, 0.02f}, {0.012f, 0.029f}, {0, 0.032f}}, detail), steps(20, detail));
        const mat4 out_of = glm::rotate(mat4(1), pi / 2, vec3(1, 0, 0));
        const float x = -w + pitch * (float(i) + 0.5f);
        kit::append(brass, knob, moved({x, height - 0.13f, front + 0.011f}) * out_of);
        kit::append(brass, knob, moved({x + (i == 0 ? 1 : -1) * (0.5f * pitch - 0.04f), 0.5f * height - 0.05f, front + 0.02f}) * out_of);
    }
}

void books(Scene& scene, const std::vector<uint32_t>& covers, uint32_t paper, const mat4& at, float width, kit::Random& random) {
    std::vector<Primitive> by_cover(covers.size());
    Primitive pages;
    pages.material = paper;
    for (float x = 0; x < width;) {
        const float thick = random.real(0.018f, 0.045f), high = random.real(0.17f, 0.25f), deep = random.real(0.12f, 0.16f);
        Primitive& cover = by_cover[random.below(uint32_t(covers.size()))];
        const float lean = random.below(6) == 0 ? 0.07f : 0;
        Primitive one, block;
        for (float side : {0.0f, thick - 0.003f}) kit::box(one, {side, 0.0005f, 0}, {side + 0.003f, high, deep}, 0.2f);
        // A rounded spine towards +z, with raised bands.
        const Profile spine = spun({{0, 0}, {thick * 0.5f, 0.008f}, {thick, 0}, {thick, 0}, {thick, -0.004f}, {thick, -0.004f}, {0, -0.004f}, {0, -0.004f}, {0, 0}}, 0.6f);
        kit::sweep(one, spine, 1, [&](vec2 p, float t) { return vec3(p.x, 0.0005f + (high - 0.0005f) * t, deep + p.y); });
        for (float y : {0.2f, 0.32f, 0.72f, 0.84f}) kit::box(one, {0.12f * thick, y * high, deep}, {0.88f * thick, y * high + 0.005f, deep + 0.0085f}, 0.2f, kit::front | kit::top | kit::bottom);
        kit::box(block, {0.0025f, 0.003f, 0.002f}, {thick - 0.0025f, high - 0.004f, deep}, 0.2f);
        const mat4 place = at * moved({x, lean > 0 ? 0.002f : 0, 0}) * glm::rotate(mat4(1), -lean, vec3(0, 0, 1));
        kit::append(cover, one, place);
        kit::append(pages, block, place);
        x += thick + 0.001f + lean * 0.24f;
    }
    std::vector<Primitive> parts;
    for (size_t i = 0; i < covers.size(); ++i) {
        by_cover[i].material = covers[i];
        if (!by_cover[i].indices.empty()) parts.push_back(std::move(by_cover[i]));
    }
    parts.push_back(std::move(pages));
    kit::add_instance(scene, kit::add_mesh(scene, "books", std::move(parts)));
}

void clock(Primitive& wood, Primitive& face, Primitive& hands, float detail) {
    // A mantel clock: a case with a rounded head, and a dial.
    Profile outline = {{0.13f, 0.03f}, {0.13f, 0.12f}};
    for (int i = 1; i < steps(24, detail); ++i) {
        const float angle = pi * float(i) / float(steps(24, detail));
        outline.push_back({0.13f * std::cos(angle), 0.12f + 0.115f * std::sin(angle)});
    }
    outline.insert(outline.end(), {{-0.13f, 0.12f}, {-0.13f, 0.03f}, {0.13f, 0.03f}});
    kit::loft(wood, outline, kit::frames_along({{0, 0, 0.02f}, {0, 0, 0.10f}}, {0, 1, 0}), {vec2(1), vec2(1)}, true);
    kit::box(wood, {-0.15f, 0, 0.005f}, {0.15f, 0.032f, 0.115f}, 0.1f);
    const mat4 up = moved({0, 0.128f, 0.1f}) * glm::rotate(mat4(1), pi / 2, vec3(1, 0, 0));
    Primitive bezel, dial;
    kit::lathe(bezel, spun({{0.092f, -0.005f}, {0.092f, 0.006f}, {0.088f, 0.010f}, {0.082f, 0.004f}, {0.080f, 0.001f}}, detail), steps(64, detail));
    kit::append(hands, bezel, up);
    kit::lathe(dial, {{0.082f, 0.002f}, {0.04f, 0.002f}, {0, 0.002f}}, steps(48, detail));
    for (size_t i = 0; i < dial.positions.size(); ++i) dial.texcoords[i] = 0.5f + vec2(dial.positions[i].x, dial.positions[i].z) / 0.166f;
    kit::append(face, dial, up);
    for (auto [angle, length, width] : {std::tuple(0.52f, 0.042f, 0.004f), {-1.05f, 0.064f, 0.003f}}) {
        Primitive hand;
        kit::box(hand, {-width / 2, -0.012f, 0.0035f}, {width / 2, length, 0.0050f}, 0.1f);
        kit::append(hands, hand, moved({0, 0.128f, 0.1f}) * glm::rotate(mat4(1), angle, vec3(0, 0, 1)));
    }
}

}  // namespace myriad::scenes::teatime
