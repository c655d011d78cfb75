// What tests of the built-in scenes share.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "scenes/scene.hpp"

namespace myriad::scenes {

// A fixture whose scene, Self::source, is loaded once for all its tests.
template <class Self>
class BuiltinTest : public testing::Test {
protected:
    static void SetUpTestSuite() {
        scene = new Scene(load(Self::source));
        triangles = new Triangles(flatten(*scene, Sharing::never));
    }
    static void TearDownTestSuite() {
        delete scene;
        delete triangles;
    }
    static inline Scene* scene = nullptr;
    static inline Triangles* triangles = nullptr;
};

// FNV-1a over everything that is rendered.
inline uint64_t hash(Scene& scene) {
    const Triangles t = flatten(scene, Sharing::never);
    uint64_t h = 14695981039346656037u;
    const auto add = [&](const void* data, size_t bytes) {
        for (size_t i = 0; i < bytes; ++i) h = (h ^ static_cast<const uint8_t*>(data)[i]) * 1099511628211u;
    };
    add(t.positions.data(), t.positions.size() * sizeof(glm::vec3));
    add(t.normals.data(), t.normals.size() * sizeof(glm::vec3));
    add(t.triangles.data(), t.triangles.size() * sizeof(glm::uvec4));
    for (const auto& texture : scene.textures) add(texture.rgba.data(), texture.rgba.size());
    return h;
}

inline uint64_t hash_of(const char* source, uint32_t seed) {
    Scene scene = load(source, seed);
    return hash(scene);
}

// The triangle that a ray meets first, by brute force; none if it escapes.
inline size_t first_hit(const Triangles& t, const glm::vec3& from, const glm::vec3& way) {
    float best = std::numeric_limits<float>::infinity();
    size_t hit = none;
    for (size_t i = 0; i < t.triangles.size(); ++i) {
        const glm::vec3 a = t.positions[t.triangles[i].x], e1 = t.positions[t.triangles[i].y] - a, e2 = t.positions[t.triangles[i].z] - a;
        const glm::vec3 p = glm::cross(way, e2);
        const float det = glm::dot(e1, p);
        if (std::abs(det) < 1e-12f) continue;
        const glm::vec3 s = from - a, q = glm::cross(s, e1);
        const float u = glm::dot(s, p) / det, v = glm::dot(way, q) / det, d = glm::dot(e2, q) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && d > 1e-4f && d < best) best = d, hit = i;
    }
    return hit;
}

// Whether what comes along `way` meets the back of the triangle, which a sheet does not have.
inline bool sees_back(const Scene& scene, const Triangles& triangles, size_t triangle, const glm::vec3& way) {
    const auto c = triangles.triangles[triangle];
    const auto& p = triangles.positions;
    return !scene.materials[c.w].double_sided && glm::dot(glm::cross(p[c.y] - p[c.x], p[c.z] - p[c.x]), way) > 0;
}

inline uint32_t material_named(const Scene& scene, const std::string& name) {
    for (uint32_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].name == name) return i;
    return none;
}

// Directed edges that no other triangle has in the opposite direction: 0 for a closed, consistently oriented mesh.
inline size_t open_edges(const Primitive& p) {
    const auto key = [&](uint32_t i) {
        // Positions, not vertex numbers: hard edges duplicate vertices. Rounded, for a seam may differ in its last bits.
        const glm::vec3 v = p.positions[i];
        return std::tuple(std::lround(v.x * 1e5), std::lround(v.y * 1e5), std::lround(v.z * 1e5));
    };
    std::map<std::pair<decltype(key(0)), decltype(key(0))>, int> edges;
    for (size_t i = 0; i < p.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) ++edges[{key(p.indices[i + k]), key(p.indices[i + (k + 1) % 3])}];
    size_t open = 0;
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        open += back == edges.end() || back->second != count;
    }
    return open;
}

// Positive when the faces look outward.
inline double signed_volume(const Primitive& p) {
    double sum = 0;
    for (size_t i = 0; i < p.indices.size(); i += 3) {
        const glm::dvec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]), c(p.positions[p.indices[i + 2]]);
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

// What a camera sees through 12 x 7 pixels of a picture of 16:9: nothing at all, or the back of a face that has one.
struct Seen {
    size_t nothing = 0, backs = 0;
};
inline Seen seen_from(const Scene& scene, const Triangles& triangles, const Camera& camera) {
    Seen seen;
    const float t = std::tan(camera.yfov / 2);
    for (int j = 0; j < 7; ++j)
        for (int i = 0; i < 12; ++i) {
            const glm::vec3 local((float(i) / 5.5f - 1) * t * 16 / 9, (float(j) / 3 - 1) * t, -1);
            const glm::vec3 way = glm::normalize(glm::mat3(camera.to_world) * local);
            const size_t hit = first_hit(triangles, glm::vec3(camera.to_world[3]), way);
            seen.nothing += hit == none;
            if (hit != none) seen.backs += sees_back(scene, triangles, hit, way);
        }
    return seen;
}

}  // namespace myriad::scenes
