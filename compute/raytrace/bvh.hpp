// A tree of boxes over a scene's triangles, on the device, for trace.glsl; see README.md.
#pragma once

#include <optional>

#include "compute/raytrace/bvh_build.hpp"
#include "engine/recorder.hpp"

namespace myriad::compute {

class Bvh {
public:
    // `opacity`: of the same triangles as world.opacity, needed where some ask; what it refers to must outlive the tree.
    // Throws OutOfMemory.
    Bvh(engine::Device& device, const WorldTriangles& world, const BvhParts& tree, OpacityReader opacity = {});
    Bvh(engine::Device& device, const WorldTriangles& world, BvhQuality quality = BvhQuality::quick, OpacityReader opacity = {})
        : Bvh(device, world, build_bvh(world, quality), std::move(opacity)) {}

    // What kernels that include trace.glsl are specialised by, beside their own: programs are made for a tree.
    engine::Constants constants(engine::Constants own = {}) const;

    // For the push constants of a kernel that includes trace.glsl. Counts as a read in the next dispatch.
    BvhRef read(engine::Recorder& recorder) const;

    // After the triangles from WorldTriangles::first_moving on have moved: takes them to where they are now, and makes the boxes above
    // them anew, a dispatch a level. Boxes hold what is in them for any positions that are finite; how well they tell rays apart is
    // the topology's, which stays. Records nothing where nothing moves.
    void refit(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles);

    uint64_t nodes() const { return nodes_.count(); }
    uint64_t triangles() const { return triangle_count_; }  // in the leaves
    uint64_t dropped() const { return dropped_; }           // zero area, not finite, nowhere, or a copy of another
    bool asks() const { return bool(opacity_); }            // some triangles are there in part
    uint64_t bytes() const { return nodes_.bytes() + triangles_.bytes() + instances_.bytes(); }
    uint64_t moving_nodes() const { return moving_ ? moving_->nodes.count() : 0; }  // that a refit visits
    const engine::Array<BvhNode>& node_array() const { return nodes_; }
    const engine::Array<BvhTriangle>& triangle_array() const { return triangles_; }
    uint depth() const { return depth_; }

private:
    struct Moving {
        Moving(engine::Device& device, const BvhMoving& found);

        engine::Program move, refit;
        engine::Array<uvec2> triangles;
        engine::Array<uint> nodes;
        engine::Array<BvhBox> boxes;
        std::vector<uint> level_ends;
    };

    engine::Array<BvhNode> nodes_;
    engine::Array<BvhTriangle> triangles_;
    engine::Array<Instance> instances_;
    std::optional<Moving> moving_;  // where something does
    OpacityReader opacity_;  // if any triangle asks
    uint64_t triangle_count_ = 0, dropped_ = 0;
    bool shared_ = false;
    uint depth_ = 0, loop_budget_ = 0;
};

}  // namespace myriad::compute
