// The scene's sparse voxel octree; see README.md and svo_io.h.
#pragma once

#include <memory>
#include <optional>

#include "compute/bsh/scene_tree.hpp"
#include "compute/instances/world.hpp"
#include "compute/svo/svo_build.h"
#include "compute/voxels/voxels.hpp"

namespace myriad::compute {

// Room to begin with; what turns out to be too little grows.
struct SvoRoom {
    uint64_t next = 0, pairs = 0, nodes = 0, inner = 0;
};

// What a build took.
struct SvoSize {
    uint64_t pairs = 0;            // of a leaf's cell and a triangle
    uint64_t nodes = 0, leaves = 0;
    uint32_t tries = 0;            // 1: there was room for all
    uint64_t bytes() const { return nodes * (sizeof(uvec2) + sizeof(uint) + sizeof(uvec2)) + blocks() * sizeof(SvoBlock); }  // of what is walked and drawn
    uint64_t blocks() const { return nodes ? nodes - leaves + 1 : 0; }
};

class Svo : public SceneTree {
public:
    static constexpr uint32_t most_levels = voxels_max_depth;

    // Of these triangles, as far as they are within [low, high], in 2^depth cells along the longest side; depth: 1 to most_levels.
    // Nothing is built yet. The world need not outlive the call.
    Svo(engine::Device& device, const WorldTriangles& world, uint32_t depth, const vec3& low, const vec3& high, SvoRoom room = {});
    Svo(Svo&&) noexcept;
    ~Svo() override;

    // Builds it of where triangles are now. Submits what is recorded and waits, for it must know whether all fitted; grows and does it again until it does.
    // `instances` may be null where triangles are not shared, `opacity` where they are everywhere. Throws OutOfMemory where memory does not suffice for this
    // many levels, InputError where numbers do not.
    void build(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
               const engine::Array<Instance>* instances = nullptr, const OpacityReader& opacity = {});
    // Frees what only a build needs, for who does not build again soon: the next build makes it anew.
    void settle();

    BshRef read(engine::Recorder& recorder) const override;
    bool empty() const override { return size_.nodes == 0; }
    uint arity() const override { return bsh_most; }
    uint levels() const override { return depth_; }

    // Specialises kernels that walk or draw it.
    static engine::Constants constants();

    uint32_t depth() const { return depth_; }
    const OctreeCube& cube() const { return cube_; }
    const SvoSize& size() const { return size_; }
    const SvoRoom& room() const { return room_; }
    // Of the tree, by node or by block.
    const engine::Array<SvoBlock>& blocks() const { return blocks_; }
    const engine::Array<uvec2>& spheres() const { return spheres_; }
    const engine::Array<uint>& cones() const { return cones_; }
    const engine::Array<uvec2>& boxes() const { return boxes_; }

private:
    struct Builder;

    void make_room();
    bool grow(const AppendReport& lists, const OctreeState& octree);

    engine::Device& device_;
    uint32_t depth_;
    OctreeCube cube_;
    uint triangle_count_;
    bool shared_, asks_;
    engine::Program leaves_, inner_;
    engine::Constants world_constants_;
    SvoRoom room_;
    SvoSize size_;
    std::unique_ptr<Builder> builder_;
    Grid grid_;
    engine::Array<uint> count_;
    engine::Array<SvoBlock> blocks_;
    engine::Array<uvec2> spheres_, boxes_;
    engine::Array<uint> cones_;
};

}  // namespace myriad::compute
