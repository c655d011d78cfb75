// The cathedral's windows: stone tracery, panes, and what is painted on them.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/builtin/cathedral_parts.hpp"

namespace myriad::scenes::cathedral {
namespace {

using glm::vec2;
using glm::vec3;
using kit::pi;
using kit::Profile;

constexpr float bar_width = 0.13f, bar_depth = 0.24f;

// A bar's section in (across, z): a roll in front and behind, hollows between them and the glass.
Profile bar(float scale) {
    const float w = 0.5f * bar_width * scale, d = 0.5f * bar_depth * scale;
    return {{w, 0}, {0.75f * w, 0.4f * d}, {0.42f * w, 0.62f * d}, {0.3f * w, 0.95f * d}, {-0.3f * w, 0.95f * d}, {-0.42f * w, 0.62f * d}, {-0.75f * w, 0.4f * d},
            {-w, 0}, {-0.75f * w, -0.4f * d}, {-0.3f * w, -0.95f * d}, {0.3f * w, -0.95f * d}, {0.75f * w, -0.4f * d}, {w, 0}};
}

// A ring of `n` foils: arcs that meet in cusps, within a circle of `radius`.
void foils(Primitive& out, vec2 centre, float radius, int n, float turn, float scale, float detail) {
    const float foil = radius * (n <= 4 ? 0.46f : 0.40f), reach = radius - foil, half = pi / float(n);
    const float to_cusp = reach * std::cos(half) - std::sqrt(std::max(0.0f, foil * foil - reach * reach * std::sin(half) * std::sin(half)));
    const float end = std::atan2(to_cusp * std::sin(half), to_cusp * std::cos(half) - reach);
    for (int i = 0; i < n; ++i) {
        const float way = turn + 2 * half * float(i);
        kit::arc_moulding(out, bar(scale), centre + reach * vec2(std::cos(way), std::sin(way)), foil, way + end, way - end, steps(12, detail));
    }
}

void circle(Primitive& out, vec2 centre, float radius, float scale, float detail) {
    kit::arc_moulding(out, bar(scale), centre, radius, 2 * pi, 0, steps(32, detail));
}

void straight(Primitive& out, vec2 a, vec2 b, float scale) {
    const vec2 across = glm::normalize(vec2(a.y - b.y, b.x - a.x));
    kit::sweep(out, bar(scale), 1, [&](vec2 p, float t) { return vec3(a + (b - a) * t + across * p.x, p.y); });
}

vec2 extent(const Opening& o) { return {2 * o.arch.half, o.spring - o.sill + o.arch.rise}; }

// Half the width of an opening at height y.
float half_width(const Opening& o, float y) {
    if (y <= o.spring) return o.arch.half;
    if (y >= o.spring + o.arch.rise - 1e-5f) return 0;
    const float h = y - o.spring, r = o.arch.radius();
    return std::sqrt(std::max(0.0f, r * r - h * h)) - o.arch.centre();
}

}  // namespace

Tracery tracery_of(const Opening& opening) {
    const Arch& arch = opening.arch;
    Tracery t;
    t.light_x = arch.half / 2;
    t.light.half = arch.half / 2;
    t.light.rise = 1.35f * t.light.half;
    // The round light touches the window's arch and both lights' arches: its radius falls with its height in the one case
    // and grows in the other.
    float low = 0.3f * arch.rise, high = arch.rise;
    const auto in_arch = [&](float y) { return arch.radius() - std::hypot(arch.centre(), y); };
    for (int i = 0; i < 40; ++i) {
        const float y = (low + high) / 2, over_light = std::hypot(t.light_x + t.light.centre(), y) - t.light.radius();
        (in_arch(y) > over_light ? low : high) = y;
    }
    t.centre = {0, opening.spring + low};
    t.radius = in_arch(low);
    return t;
}

void tracery(Primitive& out, const Opening& opening, float detail) {
    const Tracery t = tracery_of(opening);
    for (float s : {-1.0f, 1.0f}) {
        Primitive light;
        kit::arch_moulding(light, bar(1), t.light, 0, steps(20, detail));
        // Within it a trefoil head: a smaller arch that rests on two cusps.
        const float foil = 0.52f * t.light.half;
        kit::arc_moulding(light, bar(0.6f), {0, 0.52f * t.light.rise}, foil, 1.25f * pi, -0.25f * pi, steps(14, detail));
        for (float side : {-1.0f, 1.0f}) {
            const float start = side < 0 ? pi : 0.42f * pi, end = side < 0 ? 0.58f * pi : 0;
            kit::arc_moulding(light, bar(0.6f), {side * 0.42f * t.light.half, -0.1f * t.light.rise}, 0.55f * t.light.half, start, end, steps(8, detail));
        }
        kit::append(out, light, glm::translate(glm::mat4(1), vec3(s * t.light_x, opening.spring, 0)));
        straight(out, {s * opening.arch.half, opening.sill - 0.05f}, {s * opening.arch.half, opening.spring}, 1);
    }
    Primitive outline;
    kit::arch_moulding(outline, bar(1), opening.arch, 0, steps(24, detail));
    kit::append(out, outline, glm::translate(glm::mat4(1), vec3(0, opening.spring, 0)));
    straight(out, {0, opening.sill - 0.05f}, {0, opening.spring}, 1.25f);
    circle(out, t.centre, t.radius, 1, detail);
    foils(out, t.centre, t.radius - 0.03f, 6, pi / 2, 0.6f, detail);
    // Saddle bars of iron would be here; thin stone ones do as well, and hold the eye in tall windows.
    const float clear = opening.spring - opening.sill;
    for (int i = 1; i < int(clear / 1.35f); ++i) {
        const float y = opening.sill + clear * float(i) / float(int(clear / 1.35f));
        straight(out, {opening.arch.half, y}, {-opening.arch.half, y}, 0.34f);
    }
}

void rose_tracery(Primitive& out, float detail) {
    constexpr int petals = 12;
    const float hub = 0.19f * rose_radius, inner = 0.60f * rose_radius;
    circle(out, {0, 0}, rose_radius, 1.5f, detail * 2);
    circle(out, {0, 0}, hub, 1.2f, detail);
    foils(out, {0, 0}, hub - 0.02f, 6, 0, 0.6f, detail);
    const float half = pi / petals;
    for (int i = 0; i < petals; ++i) {
        const float angle = 2 * half * (float(i) + 0.5f);
        const vec2 way(std::cos(angle), std::sin(angle)), petal(std::cos(angle + half), std::sin(angle + half));
        straight(out, way * (inner + 0.05f), way * hub, 1);
        // The petals' heads between the spokes, and a roundel above each spoke.
        const float width = inner * std::sin(half);
        kit::arc_moulding(out, bar(1), petal * (inner * std::cos(half)), width, angle + half + pi / 2, angle + half - pi / 2, steps(14, detail));
        const float ring = 0.145f * rose_radius;
        circle(out, way * (rose_radius - ring - 0.06f), ring, 0.8f, 0.6f * detail);
        foils(out, way * (rose_radius - ring - 0.06f), ring - 0.03f, 4, angle, 0.5f, 0.7f * detail);
        straight(out, way * (rose_radius - 2 * ring), way * inner, 0.8f);
    }
}

void pane(Primitive& out, const Opening& o, float detail) {
    const vec2 size = extent(o);
    const auto strip = [&](float from, float to, int rows) {
        const uint32_t first = uint32_t(out.positions.size());
        kit::patch(out, steps(4, detail), rows, [&](float u, float v) {
            const float y = from + (to - from) * v;
            return vec3((2 * u - 1) * half_width(o, y), y, 0);
        });
        for (uint32_t i = first; i < out.positions.size(); ++i) {
            out.normals[i] = {0, 0, 1};
            out.texcoords[i] = vec2(out.positions[i].x + o.arch.half, out.positions[i].y - o.sill) / size;
        }
    };
    strip(o.sill - 0.02f, o.spring, steps(1.5f * (o.spring - o.sill), detail));
    strip(o.spring, o.spring + o.arch.rise, steps(6, detail));
}

void louvres(Primitive& out, const Opening& o, vec3 sun, float detail) {
    constexpr float pitch = 0.10f, depth = 0.36f;
    const vec2 size = extent(o);
    for (float y = o.sill - 0.1f; y < o.spring + o.arch.rise + 0.1f; y += pitch) {
        const vec3 up_the_light = glm::normalize(vec3(0, sun.y - y, sun.z)) * depth;
        const float half = half_width(o, std::clamp(y, o.sill, o.spring + o.arch.rise - 0.03f));
        const uint32_t first = uint32_t(out.positions.size());
        kit::quad(out, vec3(half, y, 0) - up_the_light * 0.5f, {-2 * half, 0, 0}, up_the_light, steps(4, detail), 1);
        for (uint32_t i = first; i < out.positions.size(); ++i) out.texcoords[i] = glm::clamp(vec2(out.positions[i].x + o.arch.half, y - o.sill) / size, 0.0f, 1.0f);
    }
}

void rose_pane(Primitive& out, float detail) {
    const uint32_t first = uint32_t(out.positions.size());
    kit::patch(out, steps(32, detail), steps(8, detail), [](float u, float v) {
        const float angle = 2 * pi * u, r = rose_radius * (1 - v);
        return vec3(r * std::cos(angle), r * std::sin(angle), 0);
    });
    for (uint32_t i = first; i < out.positions.size(); ++i) {
        out.normals[i] = {0, 0, 1};
        out.texcoords[i] = 0.5f + 0.5f * vec2(out.positions[i]) / rose_radius;
    }
}

namespace {

constexpr vec3 cobalt{0.03f, 0.09f, 0.62f}, azure{0.10f, 0.30f, 0.80f}, ruby{0.66f, 0.03f, 0.04f}, gold{0.85f, 0.52f, 0.08f}, emerald{0.05f, 0.42f, 0.13f},
    violet{0.30f, 0.07f, 0.42f}, amber{0.90f, 0.30f, 0.05f}, clear{0.80f, 0.78f, 0.66f}, lead{0.004f, 0.004f, 0.005f};

vec3 pick(const std::array<vec3, 6>& palette, uint32_t bits) { return palette[size_t(kit::unit(bits, 11) * 6)] * (0.7f + 0.5f * kit::unit(bits, 12)); }

struct Palette {
    std::array<vec3, 6> ground, figure, border;
};
Palette palette_of(Glass kind) {
    switch (kind) {
        case Glass::warm: return {{ruby, ruby, amber, ruby, violet, cobalt}, {gold, clear, amber, azure, emerald, gold}, {gold, cobalt, gold, ruby, clear, emerald}};
        case Glass::cool: return {{cobalt, cobalt, azure, cobalt, violet, emerald}, {gold, ruby, clear, azure, emerald, amber}, {ruby, gold, clear, ruby, azure, gold}};
        default: return {{clear, clear * 0.9f, clear * 0.8f, clear, clear * 0.7f, clear}, {clear, azure, clear, gold, clear, emerald}, {gold, azure, clear, azure, clear, ruby}};
    }
}

vec3 leaded(vec3 color, float to_border, float width) { return glm::mix(lead, color, glm::smoothstep(0.4f * width, width, to_border)); }

// A round piece of glass work: petals around an eye. `p` in radii.
vec3 roundel(vec2 p, int petals, const Palette& palette, uint32_t seed) {
    const float r = glm::length(p), turns = std::atan2(p.y, p.x) / (2 * pi) * float(petals) + float(petals);
    const int petal = int(turns) % petals;
    if (r < 0.3f) return leaded(palette.figure[seed % 6], 0.3f - r, 0.05f);
    if (r > 0.82f) return leaded(palette.border[size_t(int(turns * 2) % 6)], r - 0.82f, 0.04f);
    const float across = std::abs(turns - std::floor(turns) - 0.5f), shape = 0.42f - 0.5f * std::abs(r - 0.58f);
    if (across < shape) return leaded(palette.figure[size_t(petal + int(seed)) % 6], shape - across, 0.05f);
    return leaded(palette.ground[size_t(petal) % 6], across - shape, 0.05f);
}

}  // namespace

Texture window_glass(const char* name, const Opening& o, Glass kind, uint32_t seed) {
    const vec2 size = extent(o);
    const Tracery t = tracery_of(o);
    const Palette palette = palette_of(kind);
    const float hw = t.light.half;
    Texture texture = kit::picture(name, uint32_t(64 * size.x), uint32_t(64 * size.y), [&](vec2 uv) {
        const vec2 p((uv.x - 0.5f) * size.x, o.sill + uv.y * size.y);
        const vec2 round = (p - t.centre) / t.radius;
        if (glm::length(round) < 1) return roundel(round, 6, palette, seed);
        const float side = p.x < 0 ? -1.0f : 1.0f, x = p.x - side * t.light_x, y = p.y - o.sill;
        const uint32_t own = seed * 2 + (side < 0 ? 1 : 0);
        if (p.y > o.spring + t.light.height(x)) {  // between the lights and the arch
            const kit::Cell cell = kit::mosaic(p * 4.0f, {64, 256}, own);
            return leaded(pick(palette.ground, cell.bits), cell.to_border, 0.10f);
        }
        const float edge = hw - std::abs(x);
        if (edge < 0.15f) {  // a border of small pieces
            const int piece = int(y / 0.22f);
            const float joint = std::min(y / 0.22f - float(piece), 1 - y / 0.22f + float(piece)) * 0.22f;
            return leaded(palette.border[size_t(piece + int(own)) % 6], std::min(0.15f - edge, joint), 0.025f);
        }
        const float period = 2.3f * hw, along = y / period, v = (along - std::floor(along) - 0.5f) * period;
        const float medallion = 0.72f * hw, d = std::hypot(x, v);
        const kit::Cell fine = kit::mosaic(vec2(x, y) * 6.5f + 40.0f, {128, 256}, own);
        if (d < medallion - 0.05f) return leaded(pick(palette.figure, fine.bits), fine.to_border, 0.12f);
        if (d < medallion) return leaded(palette.border[0], std::min(d - medallion + 0.05f, medallion - d), 0.014f);
        // The ground: a diaper of lozenges.
        const vec2 q = vec2(x + y, x - y) * 3.4f, in = q - glm::floor(q) - 0.5f;
        const float lozenge = 0.5f - std::max(std::abs(in.x), std::abs(in.y));
        const bool eye = glm::length(in) < 0.2f;
        const uint32_t which = uint32_t(int(std::floor(q.x)) * 31 + int(std::floor(q.y)) * 17 + 4096) + own;
        return leaded(eye ? palette.border[which % 6] : pick(palette.ground, which), eye ? 1 : lozenge, 0.08f);
    });
    texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
    return texture;
}

Texture rose_glass(uint32_t seed) {
    const Palette cool = palette_of(Glass::cool), warm = palette_of(Glass::warm);
    Texture texture = kit::picture("rose glass", 420, 420, [&](vec2 uv) {
        const vec2 p = 2.0f * uv - 1.0f;
        const float r = glm::length(p), turns = std::atan2(p.y, p.x) / (2 * pi) * 12 + 12;
        if (r < 0.19f) return roundel(p / 0.19f, 6, warm, seed);
        const float ring = 0.145f, angle = (std::floor(turns) + 0.5f) * 2 * pi / 12;
        const vec2 q = (p - (1 - ring - 0.018f) * vec2(std::cos(angle), std::sin(angle))) / ring;
        if (glm::length(q) < 1) return roundel(q, 4, int(turns) % 2 ? warm : cool, seed + uint32_t(turns));
        if (r < 0.60f) {  // petals: figures from the hub outwards, in a ground that is red in one and blue in the next
            const float petal = turns + 0.5f, across = (petal - std::floor(petal) - 0.5f) * 2 * pi / 12 * r;
            const vec2 local(across, r - 0.43f);
            if (glm::length(local) < 0.075f) return roundel(local / 0.075f, 5, warm, seed + uint32_t(petal));
            const kit::Cell cell = kit::mosaic(p * 16.0f + 32.0f, {64, 64}, seed);
            return leaded(pick((int(petal) % 2 ? warm : cool).ground, cell.bits), cell.to_border, 0.12f);
        }
        const kit::Cell cell = kit::mosaic(p * 14.0f + 32.0f, {64, 64}, seed + 1);
        return leaded(pick(cool.ground, cell.bits), cell.to_border, 0.12f);
    });
    texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
    return texture;
}

}  // namespace myriad::scenes::cathedral
