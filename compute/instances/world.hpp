// A scene's triangles as they stand in the world, however they are stored; see README.md.
#pragma once

#include <algorithm>
#include <cassert>
#include <span>
#include <vector>

#include "compute/instances/instances.h"
#include "compute/opacity/opacity.hpp"
#include "engine/program.hpp"

namespace myriad::compute {

struct WorldTriangles {
    std::span<const glm::vec3> positions;
    std::span<const glm::uvec4> triangles;  // as stored: three indices into positions, and a fourth word that is the caller's
    std::vector<Instance> instances = {};   // by ids, without gaps; empty: a triangle's id is its index
    Opacity opacity = {};                   // of triangles as stored
    // Stored triangles from here on move from frame to frame: trees are refitted over them. They are in world space; where they are now
    // is where they start.
    uint32_t first_moving = ~0u;

    bool moves(uint32_t stored) const { return stored >= first_moving; }
    bool moves() const { return first_moving < triangles.size(); }  // any
    bool shared() const { return !instances.empty(); }
    uint32_t count() const { return shared() ? instances.back().first_id + instances.back().count : uint32_t(triangles.size()); }

    const Instance& instance(uint32_t id) const {
        const auto after = std::upper_bound(instances.begin(), instances.end(), id, [](uint32_t i, const Instance& at) { return i < at.first_id; });
        assert(after != instances.begin());
        return after[-1];
    }
    Corners stored(uint32_t triangle) const {
        const glm::uvec4 t = triangles[triangle];
        return {positions[t.x], positions[t.y], positions[t.z]};
    }
    Corners corners(uint32_t id) const {
        if (!shared()) return stored(id);
        const Instance& i = instance(id);
        return instance_corners(i, stored(i.first_triangle + (id - i.first_id)));
    }
    // Whether there is a surface at a point, and how much of one: see Opacity.
    bool is_there(uint32_t id, float u, float v, uint dice = opacity_alone) const {
        return opacity.everywhere() || opacity.is_there(place(id), id, u, v, dice);
    }
    float mean_opacity(uint32_t id, float u, float v) const { return opacity.everywhere() ? 1 : opacity.mean(place(id), u, v); }
    OpacityPlace place(uint32_t id) const {
        if (!shared()) return {id, false};
        const Instance& i = instance(id);
        return {i.first_triangle + (id - i.first_id), instance_swaps(i)};
    }
    // visit(id, index as stored, corners) for the triangles [begin, end), in the order of ids.
    template <class Visit>
    void for_each(uint32_t begin, uint32_t end, Visit visit) const {
        if (!shared()) {
            for (uint32_t t = begin; t < end; ++t) visit(t, t, stored(t));
            return;
        }
        for (uint32_t t = begin; t < end;) {
            const Instance& i = instance(t);
            for (; t < std::min(end, i.first_id + i.count); ++t) {
                const uint32_t index = i.first_triangle + (t - i.first_id);
                visit(t, index, instance_corners(i, stored(index)));
            }
        }
    }
    template <class Visit>
    void for_each(Visit visit) const { for_each(0, count(), visit); }
    // What kernels that read these triangles are specialised by.
    engine::Constants constants() const { return {{instanced_constant, shared()}}; }
};

}  // namespace myriad::compute
