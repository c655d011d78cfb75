#include "scenes/builtin/kit.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes::kit {
namespace {

using glm::vec2;
using glm::vec3;

int cells(float length, float cell) { return std::max(1, int(std::lround(length / cell))); }

// du x dv of `point`, one-sided at the border. Where the patch is pinched to a point there is none: step inside.
vec3 patch_normal(const Patch& point, float u, float v) {
    constexpr float h = 1e-3f;
    for (float step : {0.0f, 0.01f, 0.05f}) {
        const float s = u + (0.5f - u) * step, t = v + (0.5f - v) * step;
        const auto in = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
        const vec3 du = point(in(s + h), t) - point(in(s - h), t), dv = point(s, in(t + h)) - point(s, in(t - h));
        const vec3 n = glm::cross(du, dv);
        if (const float length = glm::length(n); length > 1e-4f * glm::length(du) * glm::length(dv) && length > 1e-12f)
            return n / length;
    }
    return {0, 1, 0};
}

}  // namespace

void triangle(Primitive& out, uint32_t a, uint32_t b, uint32_t c) {
    const vec3 n = glm::cross(out.positions[b] - out.positions[a], out.positions[c] - out.positions[a]);
    if (glm::length(n) > 1e-9f) out.indices.insert(out.indices.end(), {a, b, c});
}

void join_grid(Primitive& out, uint32_t first, int nu, int nv) {
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const uint32_t a = first + uint32_t(j * (nu + 1) + i), b = a + 1, c = a + uint32_t(nu) + 1, d = c + 1;
            triangle(out, a, b, d);
            triangle(out, a, d, c);
        }
}

void vertex(Primitive& out, vec3 position, vec3 normal, vec2 texcoord) {
    out.positions.push_back(position);
    out.normals.push_back(normal);
    out.texcoords.push_back(texcoord);
}

Random::Random(uint64_t seed) : state_(seed * 6364136223846793005u + 1442695040888963407u) { bits(), bits(); }

uint32_t Random::bits() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005u + 1442695040888963407u;
    const uint32_t x = uint32_t(((old >> 18) ^ old) >> 27), r = uint32_t(old >> 59);
    return (x >> r) | (x << ((32 - r) & 31));
}

void patch(Primitive& out, int nu, int nv, const Patch& point, vec2 uv_scale) {
    const uint32_t first = uint32_t(out.positions.size());
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) {
            const float u = float(i) / float(nu), v = float(j) / float(nv);
            vertex(out, point(u, v), patch_normal(point, u, v), vec2(u, v) * uv_scale);
        }
    join_grid(out, first, nu, nv);
}

void quad(Primitive& out, vec3 origin, vec3 u, vec3 v, int nu, int nv, float uv_per_metre) {
    const uint32_t first = uint32_t(out.positions.size());
    const vec3 n = glm::normalize(glm::cross(u, v));
    const vec2 uv_scale = vec2(glm::length(u), glm::length(v)) * uv_per_metre;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) {
            const vec2 at(float(i) / float(nu), float(j) / float(nv));
            vertex(out, origin + u * at.x + v * at.y, n, at * uv_scale);
        }
    join_grid(out, first, nu, nv);
}

void box(Primitive& out, vec3 lo, vec3 hi, float cell, unsigned faces) {
    const vec3 size = hi - lo, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    const int nx = cells(size.x, cell), ny = cells(size.y, cell), nz = cells(size.z, cell);
    if (faces & left) quad(out, lo, z, y, nz, ny);
    if (faces & right) quad(out, lo + x, y, z, ny, nz);
    if (faces & bottom) quad(out, lo, x, z, nx, nz);
    if (faces & top) quad(out, lo + y, z, x, nz, nx);
    if (faces & back) quad(out, lo, y, x, ny, nx);
    if (faces & front) quad(out, lo + z, x, y, nx, ny);
}

std::array<vec2, 2> profile_tangents(const Profile& profile, size_t segment) {
    const size_t n = profile.size();
    const bool closed = profile.front() == profile.back();
    constexpr float cos_crease = 0.825f;  // 0.6 radians
    const auto direction = [&](size_t s) { return glm::normalize(profile[s + 1] - profile[s]); };
    const vec2 here = direction(segment);
    const auto blend = [&](bool has, size_t other) {
        if (!has) return here;
        const vec2 there = direction(other);
        return glm::dot(here, there) < cos_crease ? here : glm::normalize(here + there);
    };
    return {blend(segment > 0 || closed, segment > 0 ? segment - 1 : n - 2), blend(segment + 2 < n || closed, segment + 2 < n ? segment + 1 : 0)};
}

void sweep(Primitive& out, const Profile& profile, int nt, const Placement& place) {
    float along = 0;  // arc length: the second texture coordinate
    for (size_t s = 0; s + 1 < profile.size(); ++s) {
        const vec2 here = glm::normalize(profile[s + 1] - profile[s]);
        const auto tangents = profile_tangents(profile, s);
        const float length = glm::length(profile[s + 1] - profile[s]);
        const uint32_t first = uint32_t(out.positions.size());
        for (int i = 0; i <= nt; ++i)
            for (int end = 0; end < 2; ++end) {
                const float t = float(i) / float(nt), h = 0.25f / float(nt);
                const vec2 p = profile[s + size_t(end)];
                // At a pole (radius 0) the sweep direction vanishes; a point just inside the segment has one.
                const vec2 q = p + (end ? -here : here) * std::min(1e-2f, 0.1f * length);
                vec3 dt = place(p, t + h) - place(p, t - h);
                if (glm::length(dt) < 1e-7f) dt = place(q, t + h) - place(q, t - h);
                const vec2 step = tangents[end] * 1e-3f;
                const vec3 dp = place(p + step, t) - place(p - step, t);
                vertex(out, place(p, t), glm::normalize(glm::cross(dp, dt)), {t, along + (end ? length : 0)});
            }
        join_grid(out, first, 1, nt);
        along += length;
    }
}

void lathe(Primitive& out, const Profile& profile, int sides, const RadiusFactor& radius_factor) {
    sweep(out, profile, sides, [&](vec2 p, float t) {
        // The first and last column of vertices must be the same bits, or the seam is not closed.
        const float angle = 2 * pi * (t == 1 ? 0 : t), r = radius_factor ? p.x * radius_factor(angle, p.y) : p.x;
        return vec3(r * std::cos(angle), p.y, r * std::sin(angle));
    });
}

void lathe(Primitive& out, const Profile& profile, int sides, vec2 axis, float from, float to, const RadiusFactor& radius_factor) {
    const bool whole = std::abs(to - from - 2 * pi) < 1e-4f;
    sweep(out, profile, sides, [&](vec2 p, float t) {
        const float angle = from + (to - from) * (whole && t == 1 ? 0 : t), r = radius_factor ? p.x * radius_factor(angle, p.y) : p.x;
        return vec3(axis.x + r * std::cos(angle), p.y, axis.y + r * std::sin(angle));
    });
}

void arc(Profile& profile, vec2 centre, float radius, float from, float to, int n) {
    for (int i = 0; i <= n; ++i) {
        const float angle = from + (to - from) * float(i) / float(n);
        profile.push_back(centre + radius * vec2(std::cos(angle), std::sin(angle)));
    }
}

void ring(Primitive& out, const Profile& profile, vec2 half, float cell) {
    constexpr vec2 corners[] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}};
    for (int side = 0; side < 4; ++side) {
        const vec2 a = corners[side], b = corners[(side + 1) % 4];
        sweep(out, profile, cells(2 * (side % 2 ? half.x : half.y), cell), [&](vec2 p, float t) {
            const vec2 r = half - p.x, at = a * r + (b * r - a * r) * t;
            return vec3(at.x, p.y, at.y);
        });
    }
}

void arch_moulding(Primitive& out, const Profile& profile, float a, float b, int segments) {
    sweep(out, profile, segments, [&](vec2 p, float t) {
        const float angle = pi * (1 - t);
        return vec3((a + p.x) * std::cos(angle), (b + p.x) * std::sin(angle), p.y);
    });
}

void arch_panel(Primitive& out, float width, float height, float radius, float thickness, int segments) {
    constexpr int rows = 5;
    const float z = thickness / 2, pier = width / 2 - radius;
    const auto curve = [&](float u) { return vec2(-radius * std::cos(pi * u), radius * std::sin(pi * u)); };
    for (float side : {1.0f, -1.0f}) {
        // Seen from its front each face runs left to right: x is mirrored for the back.
        patch(out, segments, rows, [&](float u, float v) {
            const vec2 c = curve(u);
            return vec3(side * c.x, c.y + (height - c.y) * v, side * z);
        });
        for (float x : {-width / 2, radius})
            quad(out, {side > 0 ? x : -x, 0, side * z}, {side * pier, 0, 0}, {0, height, 0}, cells(pier, 0.3f), rows);
    }
    patch(out, segments, cells(thickness, 0.25f), [&](float u, float v) {
        const vec2 c = curve(u);
        return vec3(c.x, c.y, thickness * v - z);  // seen from the opening
    });
}

void groin_vault(Primitive& out, vec2 half, float rise, int cells) {
    // Four triangular sectors, each a piece of a barrel: sector `k` lies at one wall and ends at the two groins. Its
    // barrel runs away from that wall, so height depends on the coordinate along the wall only.
    for (int k = 0; k < 4; ++k)
        patch(out, cells, std::max(2, cells / 2), [&](float u, float w) {
            const float v = w * std::min(u, 1 - u);
            vec2 at(-std::cos(pi * u), -std::cos(pi * v));
            for (int turn = 0; turn < k; ++turn) at = {-at.y, at.x};
            return vec3(at.x * half.x, rise * std::sin(pi * u), at.y * half.y);
        });
}

void drape(Primitive& cloth, const Drape& shape, Random& random, float detail) {
    const float phase = random.real(0, 2 * pi), second = random.real(0, 2 * pi), sway = random.real(-0.03f, 0.03f);
    const auto point = [&](float u, float v) {
        // 1 at the rod, `tied` at the tie, opening again below it.
        const float pull = v < 0.6f ? std::pow(v / 0.6f, 2.2f) : 1 - 0.35f * std::pow((v - 0.6f) / 0.4f, 0.8f);
        const float width = 1 - (1 - shape.tied) * pull;
        const float wave = 2 * pi * (shape.folds * u + 0.10f * std::sin(3 * v + phase));
        // Cloth keeps its length: what it loses in width goes into deeper folds.
        const float depth = 0.028f + 0.05f * (1 - width) + 0.02f * v;
        const float fold = std::sin(wave + phase) + 0.2f * std::sin(1.37f * wave + second);
        const float hem = 0.02f * std::sin(wave * 0.5f + second) * v;
        return vec3(shape.width * u * width + 0.012f * width * width * std::cos(wave + phase) + sway * v * v, -shape.height * v + hem, depth * fold);
    };
    patch(cloth, steps(9 * shape.folds, detail), steps(20, detail), [&](float u, float v) { return point(1 - u, v); }, {2, 4});
}

void append(Primitive& out, const Primitive& in, const glm::mat4& transform) {
    const uint32_t first = uint32_t(out.positions.size());
    const glm::mat3 to_normal = glm::transpose(glm::inverse(glm::mat3(transform)));
    const bool mirrored = glm::determinant(glm::mat3(transform)) < 0;
    for (size_t i = 0; i < in.positions.size(); ++i)
        vertex(out, vec3(transform * glm::vec4(in.positions[i], 1)), glm::normalize(to_normal * in.normals[i]), in.texcoords[i]);
    for (size_t i = 0; i < in.indices.size(); i += 3)
        for (size_t k : {i, i + (mirrored ? 2 : 1), i + (mirrored ? 1 : 2)}) out.indices.push_back(first + in.indices[k]);
}

uint32_t add_material(Scene& scene, const std::string& name, vec3 albedo, float roughness, uint32_t texture) {
    Material material;
    material.name = name;
    material.base_color = glm::vec4(albedo, 1);
    material.metallic = 0;
    material.roughness = roughness;
    material.base_color_texture = {texture};
    scene.materials.push_back(material);
    return uint32_t(scene.materials.size() - 1);
}

uint32_t add_mesh(Scene& scene, const std::string& name, std::vector<Primitive> primitives) {
    scene.meshes.push_back({name, std::move(primitives)});
    return uint32_t(scene.meshes.size() - 1);
}

uint32_t add_mesh(Scene& scene, const std::string& name, std::vector<std::pair<uint32_t, Primitive>> parts) {
    std::vector<Primitive> primitives;
    for (auto& [material, primitive] : parts) {
        if (primitive.indices.empty()) continue;
        primitive.material = material;
        primitives.push_back(std::move(primitive));
    }
    return add_mesh(scene, name, std::move(primitives));
}

glm::mat4 moved(vec3 by) { return glm::translate(glm::mat4(1), by); }
glm::mat4 turned(float degrees, vec3 axis) { return glm::rotate(glm::mat4(1), glm::radians(degrees), axis); }

void add_instance(Scene& scene, uint32_t mesh, const glm::mat4& to_world) { scene.instances.push_back({mesh, to_world}); }

void add_camera(Scene& scene, const std::string& name, vec3 eye, vec3 target, float yfov_degrees) {
    scene.cameras.push_back({name, glm::inverse(glm::lookAt(eye, target, vec3(0, 1, 0))), glm::radians(yfov_degrees)});
}

uint8_t srgb8(float linear) {
    // Where one code ends and the next begins: a search among 255 numbers is many times faster than a power.
    static const std::array<float, 255> ends = [] {
        std::array<float, 255> at;
        for (size_t code = 0; code < at.size(); ++code) {
            const double encoded = (double(code) + 0.5) / 255;
            at[code] = float(encoded <= 12.92 * 0.0031308 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
        }
        return at;
    }();
    return uint8_t(std::upper_bound(ends.begin(), ends.end(), linear) - ends.begin());
}

}  // namespace myriad::scenes::kit
