// Cakes and flowers.
#include <algorithm>
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

constexpr float cake_radius = 0.108f, cake_height = 0.084f;

mat4 about_y(float angle) { return glm::rotate(mat4(1), angle, vec3(0, 1, 0)); }

Profile spun(const std::vector<vec2>& points, float detail) { return kit::spline(points, std::max(2, int(5 * detail + 0.5f))); }

// A piped rosette: a fluted cone that twists to its tip.
void rosette(Primitive& out, float radius, float height, float detail) {
    kit::lathe(out, spun({{0, 0}, {0.75f * radius, 0}, {0.75f * radius, 0}, {radius, 0.22f * height}, {0.78f * radius, 0.5f * height}, {0.36f * radius, 0.8f * height}, {0, height}}, detail), steps(36, detail),
               [&](float angle, float y) { return 1 + 0.16f * std::cos(6 * angle - 2.6f * y / height) * (1 - y / height); });
}

void strawberry(Primitive& berry, Primitive& leaves, float size, const mat4& at, float detail) {
    Primitive one, calyx;
    kit::lathe(one, spun({{0, 0}, {0.30f, 0.06f}, {0.62f, 0.42f}, {0.74f, 0.85f}, {0.60f, 1.15f}, {0.25f, 1.26f}, {0, 1.24f}}, detail), steps(24, detail),
               [](float angle, float y) { return 1 + 0.035f * std::sin(9 * angle + 14 * y) * std::sin(11 * y); });
    for (int i = 0; i < 7; ++i) {
        const float angle = 2 * pi * float(i) / 7;
        const vec3 way(std::cos(angle), 0, std::sin(angle));
        const auto path = kit::spline<vec3>({vec3(0, 1.24f, 0), way * 0.25f + vec3(0, 1.30f, 0), way * 0.55f + vec3(0, 1.22f, 0), way * 0.72f + vec3(0, 1.28f, 0)}, 2);
        std::vector<vec2> width;
        for (size_t k = 0; k < path.size(); ++k) width.emplace_back(0.02f + 0.13f * std::sin(pi * float(k) / float(path.size() - 1)), 0.025f);
        kit::loft(calyx, kit::ellipse(1, 1, 6), kit::frames_along(path, {0, 1, 0}), width, true);
    }
    const mat4 to = at * glm::scale(mat4(1), vec3(size));
    kit::append(berry, one, to);
    kit::append(leaves, calyx, to);
}

// What a cake is made of between two angles: icing outside, cut faces, which show layers, inside.
void wedge(Cake& out, float from, float to, float detail) {
    const float r = cake_radius, h = cake_height;
    const Profile outline = spun({{r, 0}, {r, 0.5f * h}, {r - 0.001f, h - 0.008f}, {r - 0.007f, h - 0.0005f}, {r - 0.018f, h}, {0.5f * r, h}, {0, h}}, detail);
    // Icing was spread by hand: it is not quite round.
    const auto spread = [](float angle, float y) { return 1 + 0.008f * std::sin(7 * angle + 60 * y) * std::sin(13 * angle - 35 * y); };
    kit::lathe(out.icing, outline, steps(100 * (to - from) / (2 * pi), detail), {0, 0}, from, to, spread);
    for (bool last : {false, true}) {
        const float angle = last ? to : from;
        const vec3 way(std::cos(angle), 0, std::sin(angle));
        Primitive face;
        kit::patch(face, steps(12, detail), steps(10, detail), [&](float u, float v) {
            const float y = v * (h - 0.0008f), edge = r * spread(angle, y) - 0.0015f - (v > 0.9f ? 0.006f * std::pow((v - 0.9f) * 10, 2.0f) : 0);
            return way * (edge * (last ? u : 1 - u)) + vec3(0, y, 0);
        });
        if (!last)
            for (vec2& uv : face.texcoords) uv.x = 1 - uv.x;
        kit::append(out.inside, face, mat4(1));
    }
}

void decorate(Cake& out, float angle, float detail) {
    const vec3 way(std::cos(angle), 0, std::sin(angle));
    Primitive one;
    rosette(one, 0.0165f, 0.024f, detail);
    kit::append(out.cream, one, moved(way * (cake_radius - 0.024f) + vec3(0, cake_height - 0.001f, 0)) * about_y(-angle));
    strawberry(out.berries, out.leaves, 0.0125f, moved(way * (cake_radius - 0.024f) + vec3(0, cake_height + 0.013f, 0)) * glm::rotate(mat4(1), 0.35f, vec3(way.z, 0, -way.x)), detail);
}

// A petal: a shallow bowl that widens from its foot, its edge curled outwards by `curl`.
void petal(Primitive& out, float size, float open, float curl, const mat4& at, float detail) {
    Primitive one;
    kit::patch(one, steps(7, detail), steps(7, detail), [&](float u, float v) {
        const float across = 2 * u - 1, width = 0.16f + 0.46f * std::sin(pi * std::pow(v, 0.8f) * 0.62f);
        const float lean = open * v + curl * v * v * v, y = v * std::cos(lean * 0.9f), out_by = v * std::sin(lean) + 0.10f;
        const float edge = 1 - 0.10f * across * across * v;
        return size * vec3(width * across, y * edge, out_by - 0.34f * width * (1 - across * across * 0.5f) + 0.28f * width * (1 - across * across) + 0.05f * v * across * across);
    });
    kit::append(out, one, at);
}

void rose(Primitive& petals, Primitive& heart, float size, kit::Random& random, const mat4& at, float detail) {
    for (auto [count, open, scale, curl] : {std::tuple(4, 0.02f, 0.80f, -0.05f), {5, 0.28f, 0.95f, 0.10f}, {6, 0.62f, 1.05f, 0.35f}, {6, 1.0f, 1.10f, 0.55f}})
        for (int i = 0; i < count; ++i) {
            const float turn = 2 * pi * (float(i) + random.real(-0.12f, 0.12f)) / float(count) + open * 9;
            petal(petals, size * scale * random.real(0.93f, 1.05f), open + random.real(-0.06f, 0.06f), curl, at * about_y(turn), detail);
        }
    Primitive bud, calyx;
    kit::lathe(bud, spun({{0, 0.1f}, {0.20f, 0.2f}, {0.26f, 0.5f}, {0.16f, 0.8f}, {0, 0.88f}}, detail), steps(12, detail), [](float angle, float y) { return 1 + 0.15f * std::cos(3 * angle - 8 * y); });
    kit::append(petals, bud, at * glm::scale(mat4(1), vec3(size)));
    kit::lathe(calyx, spun({{0, -0.22f}, {0.08f, -0.2f}, {0.20f, -0.05f}, {0.26f, 0.10f}, {0.10f, 0.14f}}, detail), steps(10, detail));
    kit::append(heart, calyx, at * glm::scale(mat4(1), vec3(size)));
}

void leaf(Primitive& out, float length, float droop, const mat4& at, float detail) {
    Primitive one;
    kit::patch(one, steps(6, detail), steps(10, detail), [&](float u, float v) {
        const float across = 2 * u - 1, width = 0.24f * length * std::sin(pi * std::pow(v, 0.75f)) * (1 + 0.06f * std::sin(40 * v));
        return vec3(width * across, length * (0.55f * v - droop * v * v) + 0.25f * width * std::abs(across), length * v * (0.85f + 0.1f * v));
    });
    kit::append(out, one, at);
}

}  // namespace

void cake(Cake& out, float cut, float detail) {
    wedge(out, cut, 2 * pi, detail);
    const int rosettes = 12;
    for (int i = 0; i < rosettes; ++i) {
        const float angle = 2 * pi * (float(i) + 0.5f) / rosettes;
        if (angle > cut) decorate(out, angle, detail);
    }
    // Beads of cream around the foot.
    Primitive bead;
    rosette(bead, 0.0085f, 0.012f, 0.6f * detail);
    for (int i = 0; i < 44; ++i) {
        const float angle = 2 * pi * (float(i) + 0.5f) / 44;
        if (angle > cut + 0.04f && angle < 2 * pi - 0.04f) kit::append(out.cream, bead, moved(vec3(std::cos(angle), 0, std::sin(angle)) * (cake_radius + 0.004f)) * about_y(-angle));
    }
}

void slice(Cake& out, float cut, float detail) {
    wedge(out, -cut / 2, cut / 2, detail);
    decorate(out, 0, detail);
}

void cupcake(Primitive& paper, Primitive& icing, Primitive& berry, float detail) {
    kit::lathe(paper, {{0, 0.0005f}, {0.021f, 0}, {0.030f, 0.036f}, {0.0285f, 0.0355f}, {0, 0.036f}}, steps(112, detail), [](float angle, float y) { return 1 + 0.035f * std::cos(28 * angle) * std::min(1.0f, y / 0.006f); });
    // Icing piped in a spiral of two and a half turns, thinner as it rises.
    std::vector<vec3> path;
    std::vector<float> radii;
    const int n = steps(64, detail);
    for (int i = 0; i <= n; ++i) {
        const float t = float(i) / float(n), angle = 2 * pi * 2.6f * t, r = 0.0170f * (1 - t) + 0.0040f;
        path.push_back({r * std::cos(angle), 0.040f + 0.030f * std::pow(t, 0.85f), r * std::sin(angle)});
        radii.push_back(i == n ? 0 : 0.0105f * (1 - 0.75f * t));
    }
    kit::tube(icing, path, radii, steps(14, detail));
    kit::lathe(icing, {{0.024f, 0.036f}, {0.020f, 0.046f}, {0.010f, 0.058f}, {0, 0.062f}}, steps(20, detail));
    Primitive cherry;
    kit::lathe(cherry, spun({{0, 0}, {0.006f, 0.0015f}, {0.0085f, 0.008f}, {0.006f, 0.0145f}, {0, 0.0155f}}, detail), steps(18, detail));
    kit::append(berry, cherry, moved({0, 0.068f, 0}));
}

void macaron(Primitive& shells, Primitive& filling, float detail) {
    const int sides = steps(40, detail);
    // Each shell has a smooth cap and a frilled foot.
    const auto frill = [](float angle, float) { return 1 + 0.012f * std::cos(31 * angle); };
    const std::vector<vec2> cap = {{0.0195f, 0.0005f}, {0.0205f, 0.003f}, {0.0195f, 0.0045f}, {0.0195f, 0.0045f}, {0.0195f, 0.007f}, {0.016f, 0.0108f}, {0.009f, 0.0125f}, {0, 0.013f}};
    Primitive one;
    kit::lathe(one, spun({{0, 0.0004f}, {0.0195f, 0.0005f}}, detail), sides, frill);
    kit::lathe(one, spun(cap, detail), sides, frill);
    kit::append(shells, one, moved({0, 0.0165f, 0}));
    kit::append(shells, one, moved({0, 0.0130f, 0}) * glm::scale(mat4(1), vec3(1, -1, 1)));
    kit::lathe(filling, spun({{0.015f, 0.0125f}, {0.0185f, 0.0135f}, {0.019f, 0.0148f}, {0.0185f, 0.016f}, {0.015f, 0.017f}}, detail), sides);
}

void biscuit(Primitive& out, float detail) {
    kit::lathe(out, spun({{0, 0}, {0.022f, 0}, {0.022f, 0}, {0.025f, 0.003f}, {0.0235f, 0.007f}, {0.018f, 0.0085f}, {0.008f, 0.0085f}, {0.0055f, 0.007f}, {0.0035f, 0.007f}, {0, 0.0078f}}, detail), steps(72, detail),
               [](float angle, float y) { return 1 + 0.045f * std::cos(12 * angle) * glm::smoothstep(0.0f, 0.002f, y); });
}

void bouquet(Bouquet& out, int count, kit::Random& random, float detail) {
    kit::lathe(out.vase, spun({{0, 0.006f}, {0.036f, 0.006f}, {0.036f, 0.006f}, {0.038f, 0}, {0.038f, 0}, {0.044f, 0}, {0.044f, 0}, {0.047f, 0.010f}, {0.060f, 0.045f}, {0.064f, 0.080f}, {0.050f, 0.125f}, {0.033f, 0.155f},
                               {0.034f, 0.175f}, {0.042f, 0.190f}, {0.042f, 0.192f}, {0.040f, 0.192f}, {0.031f, 0.175f}, {0.029f, 0.155f}, {0.040f, 0.120f}}, detail), steps(72, detail));
    for (int i = 0; i < count; ++i) {
        // Spread by the golden angle, the outer ones lower and leaning out.
        const float share = std::sqrt((float(i) + 0.3f) / float(count)), angle = 2.399963f * float(i) + random.real(-0.2f, 0.2f);
        const vec3 way(std::cos(angle), 0, std::sin(angle));
        const vec3 head = way * (0.125f * share) + vec3(0, 0.335f - 0.115f * share * share + random.real(-0.012f, 0.012f), 0);
        const auto path = kit::spline<vec3>({way * 0.012f + vec3(0, 0.11f, 0), way * (0.018f + 0.008f * share) + vec3(0, 0.19f, 0), way * (0.075f * share) + vec3(0, 0.5f * (0.19f + head.y) + 0.01f, 0), head}, steps(4, detail));
        kit::tube(out.stems, path, std::vector<float>(path.size(), 0.0022f), steps(7, detail));
        const vec3 up = glm::normalize(path.back() - path[path.size() - 2]);
        const vec3 axis = glm::cross(vec3(0, 1, 0), up);
        const mat4 tilt = glm::length(axis) > 1e-4f ? glm::rotate(mat4(1), std::acos(std::clamp(up.y, -1.0f, 1.0f)), glm::normalize(axis)) : mat4(1);
        rose(out.petals, out.hearts, random.real(0.029f, 0.036f), random, moved(head) * tilt * about_y(random.real(0, 6)), detail);
        for (int k = 0; k < 2; ++k) {
            const vec3 at = path[path.size() / 2 + size_t(k)];
            leaf(out.stems, random.real(0.05f, 0.075f), random.real(0.35f, 0.9f), moved(at) * about_y(random.real(0, 2 * pi)), detail);
        }
    }
    for (int i = 0; i < 11; ++i) {  // leaves over the rim
        const float angle = 2 * pi * float(i) / 11 + random.real(-0.2f, 0.2f);
        leaf(out.stems, random.real(0.07f, 0.10f), random.real(0.7f, 1.3f), moved({0.03f * std::sin(angle), 0.185f, 0.03f * std::cos(angle)}) * about_y(angle), detail);
    }
}

}  // namespace myriad::scenes::teatime
