#include "compute/bsh/bsh.hpp"

#include <algorithm>
#include <bit>

#include "compute/bsh/bsh_order.hpp"
#include "compute/kernels.hpp"
#include "compute/surface_sampling/surface_sampling.hpp"
#include "engine/error.hpp"
#include "engine/parallel.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

engine::Constants leaf_constants(const WorldTriangles& world, uint arity) {
    engine::Constants constants = world.constants();
    constants.merge(bsh_constants(arity));
    constants[2] = world.opacity.blends();
    return constants;
}

// Blocks with a sample below that moves.
struct MovingBlocks {
    std::vector<uint> blocks, ends;
};
MovingBlocks moving_blocks_of(std::span<const uint8_t> leaf_moves, std::span<const BshLevel> levels, uint arity) {
    MovingBlocks found;
    for (uint level = 0; level < levels.size(); ++level) {
        const size_t first = found.blocks.size(), below = level > 1 ? found.ends[level - 2] : 0;
        const auto add = [&](uint block) {
            if (found.blocks.size() == first || found.blocks.back() != block) found.blocks.push_back(block);
        };
        if (level == 0) {
            for (uint leaf = 0; leaf < leaf_moves.size(); ++leaf)
                if (leaf_moves[leaf]) add(leaf / arity);
        } else {
            for (size_t i = below; i < first; ++i) add(found.blocks[i] / arity);
        }
        found.ends.push_back(uint(found.blocks.size()));
    }
    return found;
}

}  // namespace

engine::Constants bsh_constants(uint arity) {
    assert((arity == 2 || arity == 4 || arity == 8) && "masks have eight bits");
    return {{bsh_arity_constant, uint(std::countr_zero(arity))}};
}

uint bsh_arity_of(const engine::Constants& constants) {
    const auto found = constants.find(bsh_arity_constant);
    return found == constants.end() ? bsh_arity_default : 1u << found->second;
}

std::vector<BshLevel> bsh_levels(uint leaves, uint arity) {
    const uint arity_log2 = uint(std::countr_zero(arity));
    std::vector<BshLevel> levels{{leaves, 0, arity_log2}};
    do {
        const BshLevel below = levels.back();
        levels.push_back({below.blocks(), below.first_slot + arity * below.blocks(), arity_log2});
    } while (levels.back().nodes > 1);
    return levels;
}

void check_bsh_size(uint32_t log2_samples, uint arity) {
    assert(log2_samples <= 28 && "slots are 32-bit");
    const auto blocks = [&](uint32_t samples) { return bsh_levels(1u << samples, arity).back().first_block(); };
    const uint most_blocks = bsh_max_blocks - 2;  // with the one over the root
    if (blocks(log2_samples) <= most_blocks) return;
    uint32_t most = log2_samples;
    while (blocks(most) > most_blocks) --most;
    throw InputError("--samples " + std::to_string(log2_samples) + " with --arity " + std::to_string(arity) + " makes a tree of " +
                     std::to_string(blocks(log2_samples)) + " blocks, more than the cuts' " + std::to_string(most_blocks) +
                     "; give --samples " + std::to_string(most) + " at most, or --arity 8");
}

BshLeaves bsh_leaves(const WorldTriangles& world, uint32_t log2_samples, uint32_t seed) {
    assert(log2_samples <= 28 && "slots are 32-bit");
    const SurfaceSampling sampling = sample_surface(world, log2_samples, seed);
    std::vector<glm::vec3> points(sampling.samples.size());
    std::vector<SurfaceSample> leaves(points.size());
    const auto for_pieces = [&](auto work) {
        engine::parallel_pieces(points.size(), 1 << 14, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) work(i);
        });
    };
    for_pieces([&](size_t i) {
        const SurfaceSample& s = sampling.samples[i];
        const Corners c = world.corners(s.triangle);
        points[i] = bsh_position(c.p0, c.p1, c.p2, s.u, s.v);
    });
    const std::vector<uint32_t> order = bsh_order(points);
    for_pieces([&](size_t i) { leaves[i] = sampling.samples[order[i]]; });
    return {std::move(leaves), sampling.area, sampling.radius};
}

Bsh::Bsh(engine::Device& device, const WorldTriangles& world, std::span<const SurfaceSample> leaves, double area, float radius, uint arity)
    : device_(device), arity_log2_(uint(std::countr_zero(arity))),
      leaves_(device, compute_kernels, "bsh/leaves", leaf_constants(world, arity)),
      inner_(device, compute_kernels, "bsh/inner", bsh_constants(arity)), quality_(device, compute_kernels, "bsh/quality", bsh_constants(arity)),
      shared_(world.shared()), blends_(world.opacity.blends()) {
    if (leaves.empty()) return;
    assert(std::has_single_bit(leaves.size()) && leaves.size() <= uint64_t(1) << 28 && "slots are 32-bit");
    depth_ = uint(std::countr_zero(leaves.size()));
    check_bsh_size(depth_, arity);
    sample_radius_ = radius;
    area_ = area;

    levels_ = bsh_levels(uint(leaves.size()), arity);
    samples_ = engine::upload(device, "scene", "samples", leaves);
    frames_ = {device, "scene", "BSH frames", blocks() + 1};
    merged_ = {device, "scene", "BSH merged spheres", blocks()};
    spheres_ = {device, "scene", "BSH spheres", slots()};
    cones_ = {device, "scene", "BSH cones", slots()};
    boxes_ = {device, "scene", "BSH boxes", slots()};
    merged_boxes_ = {device, "scene", "BSH merged boxes", 2 * uint64_t(blocks())};
    if (!world.moves()) return;
    for (const SurfaceSample& s : leaves) leaf_moves_.push_back(world.moves(world.place(s.triangle).triangle));
    find_moving();
}

void Bsh::find_moving() {
    const MovingBlocks moving = moving_blocks_of(leaf_moves_, levels_, arity());
    moving_ = {};
    moving_ = engine::upload(device_, "scene", "BSH blocks that move", moving.blocks);
    moving_ends_ = moving.ends;
    std::vector<uint> of_tree;
    for (size_t level = 0; level < levels_.size(); ++level)
        while (of_tree.size() < moving.ends[level]) of_tree.push_back(levels_[level].first_block() + moving.blocks[of_tree.size()]);
    moving_tree_ = {};
    moving_tree_ = engine::upload(device_, "scene", "moving blocks of the BSH", of_tree);
}

void Bsh::refit(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                const engine::Array<Instance>* instances, const OpacityReader& opacity) {
    record(recorder, positions, triangles, instances, opacity, false);
}

void Bsh::refit_moving(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                       const engine::Array<Instance>* instances, const OpacityReader& opacity) {
    if (moving_.count() > 0) record(recorder, positions, triangles, instances, opacity, true);
}

void Bsh::record(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                 const engine::Array<Instance>* instances, const OpacityReader& opacity, bool moving) {
    assert((!shared_ || instances) && (!blends_ || opacity));
    ++bounds_version_;
    if (!moving) all_bounds_version_ = bounds_version_;
    for (size_t i = 0; i < levels_.size(); ++i) {
        const BshLevel& level = levels_[i];
        const uint first = moving && i > 0 ? moving_ends_[i - 1] : 0, listed = moving ? moving_ends_[i] - first : 0;
        recorder.dispatch(i == 0 ? leaves_ : inner_,
                          BshLevelPush{.frames = recorder.write(frames_),
                                       .spheres = recorder.write(spheres_),
                                       .cones = recorder.write(cones_),
                                       .merged = recorder.write(merged_),
                                       .boxes = recorder.write(boxes_),
                                       .merged_boxes = recorder.write(merged_boxes_),
                                       .samples = recorder.read(samples_),
                                       .triangles = recorder.read(triangles),
                                       .positions = recorder.read(positions),
                                       .instances = shared_ ? recorder.read(*instances) : Instances{},
                                       .opacity = blends_ && i == 0 ? opacity(recorder) : OpacityRef{},
                                       .listed = moving ? recorder.read(moving_, first) : Uints{},
                                       .leaf_radius = sample_radius_,
                                       .leaf_share = sample_share(),
                                       .nodes = level.nodes,
                                       .first_slot = level.first_slot,
                                       .first_child_block = i == 0 ? 0 : levels_[i - 1].first_block(),
                                       .first_owner = i + 1 < levels_.size() ? levels_[i + 1].first_slot : 0,
                                       .instance_count = shared_ ? uint(instances->count()) : 0,
                                       .listed_count = listed},
                          moving ? listed : level.blocks());
    }
}

void Bsh::measure(engine::Recorder& recorder) {
    if (sums_.count() == 0) sums_ = {device_, "scene", "BSH quality", bsh_quality_sums};
    recorder.dispatch(quality_,
                      BshQualityPush{.merged = recorder.read(merged_), .spheres = recorder.read(spheres_), .sums = recorder.write(sums_),
                                     .blocks = blocks()},
                      bsh_quality_sums);
}

BshQuality Bsh::quality() const {
    BshQuality quality;
    for (const vec2& sum : engine::download(device_, sums_)) quality.overlap += double(sum.x), quality.extent += double(sum.y);
    quality.overlap /= std::max(blocks(), 1u);
    return quality;
}

void Bsh::rebuild(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles,
                  const engine::Array<Instance>* instances, const OpacityReader& opacity) {
    recorder.submit_and_wait();
    const std::vector<vec4> frames = engine::download(device_, frames_, leaves() / arity() + 1);
    const std::vector<uvec2> spheres = engine::download(device_, spheres_, leaves());
    const std::vector<SurfaceSample> samples = engine::download(device_, samples_);
    std::vector<vec3> points;
    for (uint leaf = 0; leaf < leaves(); ++leaf) points.push_back(bsh_decode(frames[leaf / arity()], spheres[leaf]).center);
    const std::vector<uint32_t> order = bsh_order(points);
    std::vector<SurfaceSample> sorted;
    std::vector<uint8_t> moves;
    for (const uint32_t from : order) {
        sorted.push_back(samples[from]);
        if (!leaf_moves_.empty()) moves.push_back(leaf_moves_[from]);
    }
    engine::upload_bytes(device_, sorted.data(), samples_, samples_.bytes());
    leaf_moves_ = std::move(moves);
    if (!leaf_moves_.empty()) find_moving();
    ++rebuilds_;
    refit(recorder, positions, triangles, instances, opacity);
}

BshRef Bsh::read(engine::Recorder& recorder) const {
    assert(!empty());
    return {.frames = recorder.read(frames_),
            .spheres = recorder.read(spheres_),
            .cones = recorder.read(cones_),
            .boxes = recorder.read(boxes_),
            .leaves = leaves(),
            .blocks = blocks()};
}

uint64_t Bsh::bytes() const {
    return samples_.bytes() + frames_.bytes() + merged_.bytes() + spheres_.bytes() + cones_.bytes() + boxes_.bytes() +
           merged_boxes_.bytes();
}

}  // namespace myriad::compute
