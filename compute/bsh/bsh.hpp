// The bounding-sphere hierarchy of a scene; see README.md and bsh_io.h.
#pragma once

#include <span>
#include <vector>

#include "compute/bsh/bsh_build.h"
#include "compute/bsh/bsh_io.h"
#include "compute/bsh/scene_tree.hpp"
#include "compute/instances/world.hpp"
#include "engine/recorder.hpp"

namespace myriad::compute {

// How many children a node has, unless the scene says otherwise: README.md has why. 2, 4 or 8.
constexpr uint bsh_arity_default = 8;

// What kernels that walk trees of this arity are specialised by, and back.
engine::Constants bsh_constants(uint arity);
uint bsh_arity_of(const engine::Constants& constants);

// The levels of the tree from the leaves to the root, which is a level of its own.
struct BshLevel {
    uint nodes, first_slot, arity_log2;
    uint blocks() const { return (nodes + (1u << arity_log2) - 1) >> arity_log2; }
    uint first_block() const { return first_slot >> arity_log2; }
};
std::vector<BshLevel> bsh_levels(uint leaves, uint arity);

// Throws InputError where a tree of 2^log2_samples leaves has more blocks than cuts can name.
void check_bsh_size(uint32_t log2_samples, uint arity);

// What the host finds of a hierarchy: the samples, in the order of leaves. 2^d of them, or none where no triangle is finite.
struct BshLeaves {
    std::vector<SurfaceSample> samples;
    double area = 0;   // of the whole surface
    float radius = 0;  // of a sample's disc
};
// Samples the surface at 2^log2_samples points and finds the topology. Deterministic.
BshLeaves bsh_leaves(const WorldTriangles& world, uint32_t log2_samples, uint32_t seed);

// How tightly a tree holds its leaves, to be compared with the same tree's when it was built.
struct BshQuality {
    double overlap = 0;  // the mean over inner nodes of their children's volumes over their own
    double extent = 0;   // the sum of squares of inner nodes' radii, m^2: large nodes count most, so it grows before cuts do
};

class Bsh : public SceneTree {
public:
    // Bounds come with refit. Without samples the hierarchy is empty(): it has no leaves and must not be read.
    // Throws InputError as check_bsh_size.
    Bsh(engine::Device& device, const WorldTriangles& world, std::span<const SurfaceSample> samples, double area, float radius,
        uint arity = bsh_arity_default);
    Bsh(engine::Device& device, const WorldTriangles& world, const BshLeaves& leaves, uint arity = bsh_arity_default)
        : Bsh(device, world, leaves.samples, leaves.area, leaves.radius, arity) {}
    Bsh(engine::Device& device, const WorldTriangles& world, uint32_t log2_samples, uint32_t seed, uint arity = bsh_arity_default)
        : Bsh(device, world, bsh_leaves(world, log2_samples, seed), arity) {}

    // Computes all bounds for these positions: a dispatch a level, nothing read back. Triangles and instances are those sampled;
    // `instances` may be null where triangles are not shared, `opacity` where nothing blends.
    void refit(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
               const engine::Array<Instance>* instances = nullptr, const OpacityReader& opacity = {});

    // The same for the blocks above samples that move (WorldTriangles::first_moving); the others must be there already, and stay. Records
    // nothing where none moves.
    void refit_moving(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                      const engine::Array<Instance>* instances = nullptr, const OpacityReader& opacity = {});

    // Measures the bounds that there are; quality() has the result after the submission.
    void measure(engine::Recorder& recorder);
    BshQuality quality() const;

    // Sorts the samples into a new tree by where the bounds have them now, as they would be if it were built here, and computes all bounds.
    // Submits what is recorded. Slots, hence cuts, of before mean nothing afterwards.
    void rebuild(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                 const engine::Array<Instance>* instances = nullptr, const OpacityReader& opacity = {});
    uint rebuilds() const { return rebuilds_; }                                 // how often that was

    // For a kernel that walks the tree.
    BshRef read(engine::Recorder& recorder) const override;

    // Goes up with each refit: who keeps something made of the bounds compares.
    uint64_t bounds_version() const { return bounds_version_; }
    uint64_t all_bounds_version() const { return all_bounds_version_; }         // of the last that was of all blocks

    bool empty() const override { return levels_.empty(); }
    uint leaves() const { return empty() ? 0 : levels_.front().nodes; }
    uint blocks() const { return empty() ? 0 : levels_.back().first_block(); }  // without the one over the root
    uint slots() const { return empty() ? 0 : arity() * (blocks() + 1); }
    uint root() const { return shape().root(); }                                // its slot
    uint arity() const override { return 1u << arity_log2_; }
    BshShape shape() const { return {leaves(), blocks(), arity_log2_}; }
    uint depth() const { return depth_; }                                       // of the binary tree: leaves = 2^depth
    uint levels() const override { return empty() ? 0 : uint(levels_.size()) - 1; }      // opening steps from the root to the leaves
    float sample_radius() const { return sample_radius_; }
    float sample_share() const { return empty() ? 0 : float(area_ / leaves()); }  // m^2
    double area() const { return area_; }
    const engine::Array<SurfaceSample>& samples() const { return samples_; }    // in leaf order
    const engine::Array<vec4>& frames() const { return frames_; }
    const engine::Array<uvec2>& spheres() const { return spheres_; }
    const engine::Array<uint>& cones() const { return cones_; }
    const engine::Array<uvec2>& boxes() const { return boxes_; }
    uint64_t bytes() const;
    uint moving_blocks() const { return uint(moving_.count()); }                // that refit_moving visits
    const engine::Array<uint>& moving() const { return moving_tree_; }          // which they are

private:
    void record(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                const engine::Array<Instance>* instances, const OpacityReader& opacity, bool moving);

    void find_moving();

    engine::Device& device_;
    uint arity_log2_;
    engine::Program leaves_, inner_, quality_;
    uint rebuilds_ = 0;
    uint depth_ = 0;
    uint64_t bounds_version_ = 0, all_bounds_version_ = 0;
    bool shared_, blends_;
    std::vector<BshLevel> levels_;
    float sample_radius_ = 0;
    double area_ = 0;
    engine::Array<SurfaceSample> samples_;
    engine::Array<vec4> frames_, merged_, merged_boxes_;
    engine::Array<uvec2> spheres_, boxes_;
    engine::Array<uint> cones_;
    engine::Array<vec2> sums_;                 // of measure
    std::vector<uint8_t> leaf_moves_;          // by leaf, where any does
    engine::Array<uint> moving_;               // blocks, level after level, each level's counted from its first
    engine::Array<uint> moving_tree_;          // the same, counted from the tree's first
    std::vector<uint> moving_ends_;            // in it, of the levels
};

}  // namespace myriad::compute
