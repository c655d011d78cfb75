#include "compute/svo/svo.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "compute/kernels.hpp"
#include "compute/manylods/cut_io.h"
#include "engine/error.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {

using engine::compute_kernels;

// What only a build needs.
struct Svo::Builder {
    Voxels voxels;
    Octree octree;
    engine::Array<vec4> merged;

    Builder(engine::Device& device, const SvoRoom& room, uint32_t depth, const engine::Constants& constants)
        : voxels(device, AppendMode::scan, depth, room.next, room.pairs, constants), octree(device, room.pairs, room.nodes, depth),
          merged(device, "svo build", "merged nodes", 3 * room.inner) {}
};

namespace {

engine::Constants leaf_constants(const WorldTriangles& world) {
    engine::Constants constants = world.constants();
    constants[2] = !world.opacity.everywhere();
    return constants;
}

// How many cells triangles meet, about: as many as their area, edges and corners do on average over all places they may be at.
double pairs_guess(const WorldTriangles& world, const OctreeCube& cube) {
    double pairs = 0;
    const double scale = double(cube.cells_per_length);
    world.for_each([&](uint32_t, uint32_t, const Corners& t) {
        const glm::dvec3 a = glm::dvec3(t.p0) * scale, b = glm::dvec3(t.p1) * scale, c = glm::dvec3(t.p2) * scale;
        const glm::dvec3 n = 0.5 * glm::cross(b - a, c - a), extent = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
        const double met = std::abs(n.x) + std::abs(n.y) + std::abs(n.z) + extent.x + extent.y + extent.z + 1;
        if (std::isfinite(met)) pairs += std::min(met, 1e15);
    });
    return pairs;
}

template <class T>
uint64_t more(T needed) { return uint64_t(needed) + uint64_t(needed) / 8 + 64; }

}  // namespace

engine::Constants Svo::constants() { return {{bsh_arity_constant, 3}, {svo_constant, 1}}; }

Svo::Svo(engine::Device& device, const WorldTriangles& world, uint32_t depth, const vec3& low, const vec3& high, SvoRoom room)
    : device_(device), depth_(depth), cube_(octree_cube(low, high, depth)), triangle_count_(world.count()), shared_(world.shared()),
      asks_(!world.opacity.everywhere()), leaves_(device, compute_kernels, "svo/leaves", leaf_constants(world)), inner_(device, compute_kernels, "svo/inner"),
      world_constants_(world.constants()), room_(room), grid_(device), count_(engine::upload(device, "svo", "number of triangles", std::vector<uint>{world.count()})) {
    assert(depth >= 1 && depth <= most_levels);
    if (triangle_count_ > Voxels::max_triangles) throw InputError("an octree takes up to " + std::to_string(Voxels::max_triangles) + " triangles; give --tree bsh");
    if (room_.pairs > 0) return;
    const double most = double(AppendLists::max_capacity);
    const double pairs = std::min(pairs_guess(world, cube_) * 1.1 + 1024, most);
    room_.pairs = uint64_t(pairs);
    room_.next = uint64_t(std::min(pairs / 3 + 1.5 * triangle_count_, most));  // a level above the leaves there are a fourth as many, or all triangles still
    room_.nodes = uint64_t(1.1 * pairs);
    room_.inner = uint64_t(pairs / 3);
}
Svo::Svo(Svo&&) noexcept = default;
Svo::~Svo() = default;

void Svo::make_room() {
    const uint64_t most = cut_max_blocks - 2;
    if (std::max({room_.next, room_.pairs, room_.nodes}) > std::min(AppendLists::max_capacity, Octree::max_capacity) || room_.inner > most)
        throw InputError("an octree of " + std::to_string(depth_) + " levels meets more cells than lists can hold; give --tree svo:" + std::to_string(depth_ - 1) + " or fewer, or --tree bsh");
    try {
        if (blocks_.count() != room_.inner + 1 || spheres_.count() != room_.nodes + bsh_most) {
            builder_.reset();
            blocks_ = {}, spheres_ = {}, boxes_ = {}, cones_ = {};
            blocks_ = {device_, "svo", "blocks of the octree", room_.inner + 1};
            spheres_ = {device_, "svo", "spheres of the octree", room_.nodes + bsh_most};
            boxes_ = {device_, "svo", "boxes of the octree", room_.nodes};
            cones_ = {device_, "svo", "cones of the octree", room_.nodes + bsh_most};
        }
        if (!builder_) builder_ = std::make_unique<Builder>(device_, room_, depth_, world_constants_);
    } catch (const OutOfMemory& e) {
        builder_.reset();
        throw OutOfMemory("an octree of " + std::to_string(depth_) + " levels, of " + std::to_string(room_.pairs) + " cells that triangles meet, does not fit (" + e.what() +
                          "); give --tree svo:" + std::to_string(depth_ - 1) + " or fewer, or --tree bsh");
    }
}

// Whether something was too short.
bool Svo::grow(const AppendReport& lists, const OctreeState& octree) {
    if (lists.next_overflowed) room_.next = 2 * more(lists.next_needed);  // hides what came after it
    if (lists.kept_overflowed) room_.pairs = more(lists.kept_needed), room_.nodes = std::max(room_.nodes, room_.pairs);
    if (!lists.ok()) return builder_.reset(), true;
    if (octree.failed) return room_.nodes = more(octree.needed), builder_.reset(), true;
    if (octree.first[depth_] > room_.inner) return room_.inner = more(octree.first[depth_]), builder_.reset(), true;
    return false;
}

void Svo::build(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                const engine::Array<Instance>* instances, const OpacityReader& opacity) {
    assert((!shared_ || instances) && (!asks_ || opacity));
    size_ = {};
    if (triangle_count_ == 0) return;
    const uint instance_count = shared_ ? uint(instances->count()) : 0;
    for (bool again = true; again;) {
        make_room();
        ++size_.tries;
        Voxels& voxels = builder_->voxels;
        Octree& octree = builder_->octree;
        const uint shape = depth_ << 28 | uint(room_.inner);
        {
            auto scope = recorder.scope("voxels");
            voxels.record(recorder, {positions, triangles, shared_ ? instances : nullptr, instance_count}, count_, 0, triangle_count_, cube_);
            voxels.record_items(recorder, octree);
        }
        octree.record(recorder, voxels.lists().state(), AppendLists::kept_word);
        octree.end(recorder);
        {
            auto scope = recorder.scope("octree leaves");
            grid_.dispatch(recorder, leaves_, octree.state(), Octree::count_word + depth_ - 1, room_.inner, 1, [&] {
                return SvoLeavesPush{.blocks = {recorder.write(blocks_).address}, .spheres = recorder.write(spheres_), .cones = recorder.write(cones_),
                                     .boxes = recorder.write(boxes_), .merged = recorder.write(builder_->merged), .octree = octree.read(recorder),
                                     .triangles = recorder.read(triangles), .positions = recorder.read(positions),
                                     .instances = shared_ ? recorder.read(*instances) : Instances{}, .opacity = asks_ ? opacity(recorder) : OpacityRef{},
                                     .cube = cube_, .instance_count = instance_count, .shape = shape};
            });
        }
        {
            auto scope = recorder.scope("octree inner nodes");
            for (uint32_t level = depth_ - 1; level-- > 0;)
                grid_.dispatch(recorder, inner_, octree.state(), Octree::count_word + level, room_.inner, 1, [&] {
                    return SvoInnerPush{.blocks = {recorder.write(blocks_).address}, .spheres = recorder.write(spheres_), .cones = recorder.write(cones_),
                                        .boxes = recorder.write(boxes_), .merged = recorder.write(builder_->merged), .octree = octree.read(recorder), .level = level,
                                        .shape = shape};
                });
        }
        recorder.submit_and_wait();
        const OctreeState state = octree.report().state;
        const AppendReport lists = voxels.lists().report();
        size_.pairs = lists.kept, size_.nodes = state.first[depth_ + 1], size_.leaves = state.count[depth_];
        again = grow(lists, state);
    }
}

void Svo::settle() { builder_.reset(); }

BshRef Svo::read(engine::Recorder& recorder) const {
    assert(!empty());
    return {.frames = {recorder.read(blocks_).address}, .spheres = recorder.read(spheres_), .cones = recorder.read(cones_), .boxes = recorder.read(boxes_), .leaves = 0,
            .blocks = 0};
}

}  // namespace myriad::compute
