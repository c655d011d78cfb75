#include "scenes/builtin/atrium_parts.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes::atrium {
namespace {

using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::arc;
using kit::pi;
using kit::Profile;
using kit::moved;
using kit::turned;

// Attic base and bell capital around a shaft from radius r0 at y0 to r1 at y1; the shaft itself is added by the caller.
void base_and_capital(Primitive& out, float r0, float r1, float height, float abacus, float detail) {
    const float plinth = 0.4f * abacus + 0.06f, y0 = 0.3f, y1 = height - 0.42f;
    kit::box(out, {-plinth, 0, -plinth}, {plinth, 0.1f, plinth}, 0.25f / detail, kit::all_faces & ~kit::bottom);
    Profile base;
    arc(base, {r0 + 0.02f, 0.145f}, 0.055f, -pi / 2, pi / 2, 4);
    arc(base, {r0 + 0.055f, 0.225f}, 0.025f, 1.5f * pi, pi, 2);
    arc(base, {r0 + 0.0f, 0.275f}, 0.028f, -pi / 2, pi / 2, 3);
    base.push_back({r0 - 0.03f, y0 + 0.003f});
    kit::lathe(out, base, steps(28, detail));
    Profile capital;
    arc(capital, {r1, y1 + 0.01f}, 0.022f, -pi / 2, pi / 2, 3);
    capital.push_back({r1 - 0.01f, y1 + 0.06f});
    const float lip = abacus - 0.03f;
    for (int i = 0; i <= 6; ++i) {  // the bell: slow, then flaring out
        const float t = float(i) / 6;
        capital.push_back({r1 + (lip - r1) * t * t * t, y1 + 0.07f + 0.22f * std::sin(t * pi / 2)});
    }
    capital.push_back({lip, height - 0.1f});
    // Leaves: the bell swells eight times around, most at its lip.
    kit::lathe(out, capital, steps(40, detail), [&](float angle, float y) {
        const float t = std::clamp((y - y1 - 0.07f) / 0.22f, 0.0f, 1.0f);
        return 1 + 0.10f * t * (1.3f - t) * std::cos(8 * angle);
    });
    kit::box(out, {-abacus, height - 0.11f, -abacus}, {abacus, height - 0.06f, abacus}, 0.25f / detail, kit::all_faces);
    const float upper = abacus - 0.03f;
    kit::box(out, {-upper, height - 0.07f, -upper}, {upper, height + 0.01f, upper}, 0.25f / detail, kit::all_faces & ~kit::top);
}

Profile shaft(float r0, float r1, float y0, float y1, int rows) {
    Profile profile;
    for (int i = 0; i <= rows; ++i) {
        const float t = float(i) / float(rows);
        // Entasis: the lower third hardly tapers.
        profile.push_back({r0 + (r1 - r0) * t * t * (1.5f - 0.5f * t), y0 + (y1 - y0) * t});
    }
    return profile;
}

}  // namespace

void lower_column(Primitive& out, float height, float detail) {
    base_and_capital(out, 0.25f, 0.21f, height, 0.34f, detail);
    kit::lathe(out, shaft(0.25f, 0.21f, 0.29f, height - 0.41f, steps(4, detail)), steps(80, detail),
               [](float angle, float) { return 1 - 0.07f * std::abs(std::sin(10 * angle)); });
}

void upper_column(Primitive& out, float height, float detail) {
    base_and_capital(out, 0.16f, 0.145f, height, 0.30f, detail);
    kit::lathe(out, shaft(0.165f, 0.15f, 0.29f, height - 0.41f, steps(13, detail)), steps(32, detail),
               [](float angle, float y) { return 1 + 0.09f * std::cos(6 * angle - 7 * y); });
}

void pedestal(Primitive& out, float height, float detail) {
    const float cell = 0.25f / detail;
    kit::box(out, {-0.27f, -0.02f, -0.27f}, {0.27f, 0.12f, 0.27f}, cell, kit::all_faces & ~kit::bottom);
    kit::box(out, {-0.23f, 0.1f, -0.23f}, {0.23f, height - 0.08f, 0.23f}, cell, kit::all_faces & ~(kit::bottom | kit::top));
    kit::box(out, {-0.28f, height - 0.1f, -0.28f}, {0.28f, height, 0.28f}, cell);
}

void balustrade(Primitive& out, float clear_width, float detail) {
    const float half = clear_width / 2, cell = 0.25f / detail;
    const unsigned sides = kit::all_faces & ~(kit::left | kit::right);
    kit::box(out, {-half, -0.01f, -0.10f}, {half, 0.12f, 0.10f}, cell, sides & ~kit::bottom);
    kit::box(out, {-half, 0.82f, -0.09f}, {half, 0.87f, 0.09f}, cell, sides);
    kit::box(out, {-half, 0.86f, -0.13f}, {half, 0.97f, 0.13f}, cell, sides);
    Primitive one;
    Profile profile = {{0.055f, 0.11f}, {0.055f, 0.16f}, {0.03f, 0.18f}};
    for (int i = 0; i <= 6; ++i) {  // the belly, low and full
        const float t = float(i) / 6;
        profile.push_back({0.028f + 0.047f * std::pow(std::sin(pi * std::pow(t, 0.62f)), 2.0f), 0.20f + 0.46f * t});
    }
    for (vec2 p : {vec2(0.045f, 0.67f), vec2(0.045f, 0.70f), vec2(0.03f, 0.72f), vec2(0.055f, 0.76f), vec2(0.055f, 0.83f)}) profile.push_back(p);
    kit::lathe(one, profile, steps(8, detail));
    const int count = std::max(1, int(clear_width / 0.24f));
    for (int i = 0; i < count; ++i) kit::append(out, one, moved({-half + clear_width * (float(i) + 0.5f) / float(count), 0, 0}));
}

void arcade_bay(Primitive& wall, Primitive& trim, float radius, float height, float detail) {
    const int segments = steps(24, detail);
    kit::arch_panel(wall, bay, height, radius, wall_thickness, segments);
    const float z = wall_thickness / 2;
    Primitive one;
    const Profile archivolt = {{0.25f, z - 0.03f}, {0.25f, z + 0.03f}, {0.21f, z + 0.06f}, {0.15f, z + 0.06f},
                               {0.14f, z + 0.035f}, {0.05f, z + 0.035f}, {0.02f, z - 0.03f}};
    kit::arch_moulding(one, archivolt, radius, radius, segments);
    // The keystone, a wedge: a box whose upper end is wider.
    const float y0 = radius - 0.04f, y1 = radius + 0.34f, front = z + 0.10f;
    const auto edge = [&](float side, float y, float at) { return vec3(side * (0.07f + 0.05f * (y - y0) / (y1 - y0)), y, at); };
    kit::patch(one, 1, 3, [&](float u, float v) { return edge(2 * u - 1, y0 + (y1 - y0) * v, front); });
    for (float s : {-1.0f, 1.0f}) {
        const vec3 a = edge(s, y0, z - 0.05f), b = edge(s, y0, front), up = edge(s, y1, front) - b;
        kit::quad(one, s < 0 ? a : b, s < 0 ? b - a : a - b, up, 1, 3);
    }
    kit::quad(one, edge(-1, y1, front), edge(1, y1, front) - edge(-1, y1, front), {0, 0, z - 0.05f - front}, 1, 1);
    kit::quad(one, edge(-1, y0, z - 0.05f), edge(1, y0, front) - edge(-1, y0, front), {0, 0, front - z + 0.05f}, 1, 1);  // soffit
    kit::append(trim, one, mat4(1));
    kit::append(trim, one, turned(180, {0, 1, 0}));
}

void medallion(Primitive& frame, Primitive& boss, float detail) {
    const mat4 face = turned(90, {1, 0, 0});
    Primitive ring, disc;
    Profile profile;
    arc(profile, {0.25f, 0.0f}, 0.045f, 0, pi, 4);
    kit::lathe(ring, profile, steps(24, detail));
    Profile dome = {{0.22f, 0.008f}};
    arc(dome, {0.0f, -0.21f}, 0.26f, 0.95f, pi / 2, 4);
    dome.back().x = 0;
    kit::lathe(disc, dome, steps(24, detail), [](float angle, float y) { return y > 0.009f ? 1 + 0.12f * std::cos(6 * angle) : 1; });
    kit::append(frame, ring, face);
    kit::append(boss, disc, face);
}

void door(Primitive& frame, Primitive& wood, float detail) {
    const float cell = 0.3f / detail;
    for (float s : {-1.0f, 1.0f}) {
        const float x = s * 0.66f;
        kit::box(frame, {x - 0.1f, -0.02f, -0.05f}, {x + 0.1f, 2.3f, 0.09f}, cell, kit::all_faces & ~kit::back);
        kit::box(frame, {x - 0.13f, -0.02f, -0.05f}, {x + 0.13f, 0.25f, 0.12f}, cell, kit::all_faces & ~kit::back);
    }
    kit::box(frame, {-0.80f, 2.28f, -0.05f}, {0.80f, 2.48f, 0.10f}, cell, kit::all_faces & ~kit::back);
    kit::box(frame, {-0.88f, 2.47f, -0.05f}, {0.88f, 2.55f, 0.18f}, cell, kit::all_faces & ~kit::back);
    kit::box(wood, {-0.57f, 0, -0.05f}, {0.57f, 2.29f, 0.03f}, cell, kit::front);
    for (float x : {-0.285f, 0.285f})
        for (int row = 0; row < 4; ++row) {
            const float y = 0.14f + 0.54f * float(row);
            kit::box(wood, {x - 0.22f, y, 0}, {x + 0.22f, y + 0.44f, 0.055f}, cell, kit::all_faces & ~kit::back);
            kit::box(wood, {x - 0.15f, y + 0.07f, 0}, {x + 0.15f, y + 0.37f, 0.075f}, cell, kit::all_faces & ~kit::back);
        }
}

void window(Primitive& frame, Primitive& wood, float detail) {
    const float cell = 0.3f / detail, w = 0.55f, h = 1.7f;
    for (float s : {-1.0f, 1.0f})
        kit::box(frame, {s * w - 0.08f, 0, -0.05f}, {s * w + 0.08f, h, 0.07f}, cell, kit::all_faces & ~kit::back);
    kit::box(frame, {-w - 0.16f, -0.1f, -0.05f}, {w + 0.16f, 0.02f, 0.16f}, cell, kit::all_faces & ~kit::back);
    kit::box(frame, {-w - 0.12f, h - 0.01f, -0.05f}, {w + 0.12f, h + 0.14f, 0.10f}, cell, kit::all_faces & ~kit::back);
    kit::box(wood, {-w, 0, -0.05f}, {w, h, 0.005f}, cell, kit::front);
    for (float leaf : {-0.27f, 0.27f}) {
        for (float s : {-1.0f, 1.0f})
            kit::box(wood, {leaf + s * 0.215f - 0.035f, 0.03f, 0}, {leaf + s * 0.215f + 0.035f, h - 0.03f, 0.05f}, cell, kit::all_faces & ~kit::back);
        // Louvres: slats that lean outward.
        for (int i = 0; i < 22; ++i) {
            const float y = 0.07f + (h - 0.16f) * float(i) / 22;
            kit::quad(wood, {leaf - 0.19f, y, 0.045f}, {0.38f, 0, 0}, {0, 0.06f, -0.04f}, 1, 1);
            kit::quad(wood, {leaf - 0.19f, y, 0.006f}, {0.38f, 0, 0}, {0, 0, 0.039f}, 1, 1);
        }
    }
}

void fountain(Primitive& stone, Primitive& water, float detail) {
    const int sides = steps(60, detail);
    Profile step = {{2.05f, -0.02f}, {2.05f, 0.13f}, {2.02f, 0.15f}, {1.5f, 0.15f}};
    kit::lathe(stone, step, sides);
    Profile basin = {{1.62f, 0.14f}, {1.62f, 0.22f}, {1.56f, 0.25f}};
    arc(basin, {1.55f, 0.42f}, 0.16f, -1.2f, 0.3f, 6);
    arc(basin, {1.68f, 0.56f}, 0.05f, -pi / 2, pi / 2, 6);
    basin.push_back({1.50f, 0.61f});
    basin.push_back({1.46f, 0.59f});
    basin.push_back({1.44f, 0.40f});
    kit::lathe(stone, basin, sides, [](float angle, float y) { return 1 + 0.012f * glm::smoothstep(0.26f, 0.34f, y) * (1 - glm::smoothstep(0.46f, 0.54f, y)) * std::cos(10 * angle); });
    Profile stem = {{0.42f, 0.40f}, {0.42f, 0.58f}, {0.36f, 0.62f}, {0.22f, 0.68f}};
    for (int i = 0; i <= 10; ++i) {
        const float t = float(i) / 10;
        stem.push_back({0.13f + 0.11f * std::pow(std::sin(pi * std::pow(t, 0.7f)), 2.0f), 0.72f + 0.62f * t});
    }
    for (int i = 0; i <= 8; ++i) {  // underside of the bowl
        const float t = float(i) / 8;
        stem.push_back({0.15f + 0.68f * std::sin(t * pi / 2), 1.36f + 0.26f * (1 - std::cos(t * pi / 2))});
    }
    for (vec2 p : {vec2(0.86f, 1.64f), vec2(0.86f, 1.69f), vec2(0.80f, 1.70f), vec2(0.77f, 1.62f)}) stem.push_back(p);
    kit::lathe(stone, stem, sides, [](float angle, float y) { return 1 + 0.02f * glm::smoothstep(1.38f, 1.46f, y) * (1 - glm::smoothstep(1.54f, 1.62f, y)) * std::cos(10 * angle); });
    Profile top = {{0.10f, 1.60f}, {0.10f, 1.75f}, {0.06f, 1.80f}};
    arc(top, {0.02f, 1.93f}, 0.11f, -1.0f, 1.2f, 8);
    top.push_back({0.03f, 2.10f});
    top.push_back({0, 2.16f});
    kit::lathe(stone, top, steps(32, detail));
    // Water: rings run out over the basin.
    Profile pool, bowl;
    for (int i = 0; i <= 24; ++i) pool.push_back({1.46f - 1.05f * float(i) / 24, 0.52f + 0.006f * std::sin(float(i) * 1.9f)});
    kit::lathe(water, pool, sides);
    for (int i = 0; i <= 10; ++i) bowl.push_back({0.79f - 0.70f * float(i) / 10, 1.66f + 0.004f * std::sin(float(i) * 1.9f)});
    kit::lathe(water, bowl, sides);
}

void pot(Primitive& clay, Primitive& earth, float detail) {
    Profile profile = {{0.24f, 0}, {0.26f, 0.05f}, {0.24f, 0.08f}};
    for (int i = 0; i <= 8; ++i) profile.push_back({0.24f + 0.14f * std::sin(float(i) / 8 * 1.9f), 0.1f + 0.42f * float(i) / 8});
    arc(profile, {0.385f, 0.58f}, 0.045f, -pi / 2, pi / 2, 6);
    profile.push_back({0.34f, 0.62f});
    profile.push_back({0.33f, 0.50f});
    kit::lathe(clay, profile, steps(40, detail));
    kit::lathe(earth, {{0.335f, 0.55f}, {0.15f, 0.57f}, {0, 0.58f}}, steps(24, detail));
}

void shrub(Primitive& leaves, kit::Random& random, float detail) {
    const int count = steps(520, detail);
    for (int i = 0; i < count; ++i) {
        // On a ball, denser at its skin: pointed leaves that look outward and hang a little.
        const float z = random.real(-0.8f, 1), angle = random.real(0, 2 * pi), r = std::sqrt(1 - z * z);
        const vec3 out(r * std::cos(angle), z, r * std::sin(angle));
        const vec3 at = vec3(0, 1.02f, 0) + out * (0.46f * std::cbrt(random.real(0.35f, 1.2f)));
        const vec3 side = glm::normalize(glm::cross(out, vec3(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)) + vec3(0, 0.01f, 0)));
        const vec3 tip = glm::normalize(out * random.real(0.3f, 1) + glm::cross(side, out) + vec3(0, -0.25f, 0));
        const float length = random.real(0.07f, 0.13f), width = 0.34f * length;
        kit::patch(leaves, 1, 2, [&](float u, float v) {
            const float across = (u - 0.5f) * 2 * width * std::sin(pi * (0.08f + 0.85f * v));
            return at + side * across + tip * (length * v) + out * (-0.25f * length * v * v);
        });
    }
    // A stem, so that the ball stands on something.
    kit::lathe(leaves, {{0.03f, 0.5f}, {0.025f, 1.0f}}, 6);
}

void runner(Primitive& cloth, float width, float fall, kit::Random& random, float detail) {
    const float phase = random.real(0, 2 * pi);
    // The path of its middle, (z, y), measured from the top of the rail: behind the rail, over it, out over the cornice.
    const Profile path = {{-0.155f, -0.5f}, {-0.15f, 0.0f}, {-0.12f, 0.03f}, {0.12f, 0.03f}, {0.16f, -0.02f}, {0.24f, -0.45f}, {0.40f, -0.80f},
                          {0.60f, -0.92f}, {0.64f, -1.02f}, {0.645f, -1.02f - fall}};
    std::vector<float> at = {0};
    for (size_t i = 1; i < path.size(); ++i) at.push_back(at.back() + glm::length(path[i] - path[i - 1]));
    kit::patch(cloth, steps(20, detail), steps(48, detail), [&](float u, float v) {
        const float s = v * at.back();
        size_t k = 1;
        while (k + 1 < path.size() && at[k] < s) ++k;
        const vec2 p = path[k - 1] + (path[k] - path[k - 1]) * ((s - at[k - 1]) / (at[k] - at[k - 1]));
        const float hang = std::clamp((s - at[8]) / fall, 0.0f, 1.0f);
        const float fold = 0.035f * hang * std::sin(2 * pi * (2.5f * u + 0.1f * std::sin(4 * v)) + phase);
        const float point = 0.25f * hang * (1 - std::abs(2 * u - 1));  // swallow-less: the lower edge comes to a point
        const float tail = std::clamp(1 - s / 0.5f, 0.0f, 1.0f);  // the end behind the rail
        return vec3((u - 0.5f) * width * (1 - 0.06f * hang - 0.05f * tail), p.y - point * hang + 0.05f * tail * std::sin(5 * u + phase),
                    p.x + 0.03f * hang + fold - tail * (0.02f + 0.022f * std::sin(15 * u + phase)));
    }, {1, 3});
}

void rod(Primitive& iron, float width, float detail) {
    Primitive one;
    const float half = width / 2;
    Profile profile = {{0.022f, -half}, {0.022f, half}};
    kit::lathe(one, profile, steps(10, detail));
    kit::append(iron, one, turned(-90, {0, 0, 1}));
}

Texture paving(const char* name, int tiles, bool checker, vec3 light, vec3 dark, kit::Random& random) {
    constexpr int size = 512;
    Texture texture;
    texture.name = name;
    texture.width = texture.height = size;
    texture.rgba.resize(size * size * 4);
    std::vector<float> tint(size_t(tiles * tiles));
    for (auto& t : tint) t = random.real(0.82f, 1.08f);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const int cell = size / tiles, i = x / cell % tiles, j = y / cell % tiles, edge = std::max(1, cell / 40);
            const bool joint = x % cell < edge || y % cell < edge;
            vec3 color = checker && (i + j) % 2 ? dark : light;
            color *= tint[size_t(j * tiles + i)] * random.real(0.94f, 1.03f) * (joint ? 0.55f : 1.0f);
            for (int c = 0; c < 3; ++c) texture.rgba[size_t((y * size + x) * 4 + c)] = kit::srgb8(color[c]);
            texture.rgba[size_t((y * size + x) * 4 + 3)] = 255;
        }
    return texture;
}

}  // namespace myriad::scenes::atrium
