#include "passes/pick/pick.hpp"

#include <algorithm>

#include "passes/kernels.hpp"

namespace myriad::passes {

using engine::passes_kernels;

namespace {

uint32_t tiles_of(const PickSettings& s) { return pick_columns(s.width, s.side) * pick_columns(s.height, s.side); }

engine::Program gather_program(engine::Device& device, const PickSettings& s, engine::Constants variant) {
    const uint32_t across = s.side / s.block;
    variant[0] = across * across;
    variant[glossy_constant] = s.glossy;
    if (s.visibility == GatherVisibility::rays) return {device, passes_kernels, "pick/rays", variant};
    return {device, passes_kernels, "pick/maps", {{0, across * across}, {2, s.visibility == GatherVisibility::maps}, {glossy_constant, s.glossy}}};
}

}  // namespace

PickPass::PickPass(engine::Device& device, const PickSettings& s, const engine::Constants& variant)
    : settings_(s), tile_count_(tiles_of(s)), part_(pick_part(s.vpls)), parts_((s.vpls + part_ - 1) / part_), tree_(device, s.vpls),
      tiles_kernel_(device, passes_kernels, "pick/tiles"), gather_(gather_program(device, s, variant)), tiles_(device, "picks", "tiles of receivers", tile_count_),
      picks_(device, "picks", "picks", uint64_t(tile_count_) * pick_sets(s.block) * s.picks),
      irradiance_(device, "images", "irradiance", uint64_t(s.width) * s.height * (s.glossy ? 2 : 1)) {
    assert(s.picks >= 1 && s.picks <= pick_most && s.side % s.block == 0 && s.side <= 255);
    pick_.emplace(device, passes_kernels, s.method == PickMethod::tree ? "pick/tree" : "pick/culled");
    if (s.method == PickMethod::tree) {
        weigh_.emplace(device, passes_kernels, "pick/weigh");
        sum_.emplace(device, passes_kernels, "pick/sum");
        weights_ = {device, "picks", "weights of nodes", uint64_t(tile_count_) * pick_weights(pick_sets(s.block), s.picks)};
        return;
    }
    remain_kernel_.emplace(device, passes_kernels, "pick/remain");
    remain_ = {device, "picks", "VPLs that remain", uint64_t(tile_count_) * parts_};
}

void PickPass::record_picks(engine::Recorder& recorder, const GBuffer& gbuffer, const compute::ViewTree& views, const engine::Array<Vpl>& vpls,
                            const engine::Array<uint>& count, float bound) {
    bound_ = bound;
    {
        auto scope = recorder.scope("light tree");
        tree_.record(recorder, views, vpls, count);
    }
    auto scope = recorder.scope("picks");
    recorder.dispatch(tiles_kernel_, PickTilesPush{.gbuffer = gbuffer.read(recorder), .tiles = recorder.write(tiles_), .side = settings_.side}, tile_count_);
    if (settings_.method == PickMethod::tree) {
        const uint32_t limit = pick_weights(pick_sets(settings_.block), settings_.picks);
        for (const engine::Program* kernel : {&*weigh_, &*sum_})
            recorder.dispatch(*kernel,
                              PickWeighPush{.tiles = recorder.read(tiles_), .nodes = recorder.read(tree_.nodes()), .levels = views.read_levels(recorder),
                                            .weights = recorder.write(weights_), .tile_count = tile_count_, .capacity = tree_.capacity(), .limit = limit, .bound = bound_},
                              kernel == &*weigh_ ? (tile_count_ + kernel->workgroup_size() - 1) / kernel->workgroup_size() * uint64_t(limit) * kernel->workgroup_size() : tile_count_);
        const uint32_t parts = (pick_sets(settings_.block) * settings_.picks + pick_a_walk - 1) / pick_a_walk;
        recorder.dispatch(*pick_,
                          PickTreePush{.tiles = recorder.read(tiles_), .nodes = recorder.read(tree_.nodes()), .count = recorder.read(count),
                                       .picks = recorder.write(picks_), .weights = recorder.read(weights_), .shape = shape(), .tile_count = tile_count_, .parts = parts,
                                       .capacity = tree_.capacity(), .limit = limit, .bound = bound_},
                          uint64_t(tile_count_) * parts);
        return;
    }
    for (const engine::Program* kernel : {&*remain_kernel_, &*pick_})
        recorder.dispatch(*kernel,
                          PickCulledPush{.tiles = recorder.read(tiles_), .nodes = recorder.read(tree_.nodes()), .groups = recorder.read(views.groups()),
                                         .count = recorder.read(count), .remain = kernel == &*pick_ ? recorder.read(remain_) : recorder.write(remain_),
                                         .picks = recorder.write(picks_), .shape = shape(), .tile_count = tile_count_, .parts = parts_, .part = part_,
                                         .capacity = tree_.capacity(), .reach = settings_.reach},
                          uint64_t(tile_count_) * parts_);
}

void PickPass::record_maps(engine::Recorder& recorder, const GBuffer& gbuffer, uint32_t first, uint32_t limit, const engine::Array<uint>* atlas,
                           uint32_t map_size, float bias, const compute::AppendLists* lists) {
    assert((settings_.visibility == GatherVisibility::none) == (atlas == nullptr));
    recorder.dispatch(gather_,
                      PickMapsPush{.gbuffer = gbuffer.read(recorder), .vpls = recorder.read(tree_.lights()), .picks = recorder.read(picks_),
                                   .atlas = atlas ? recorder.read(*atlas) : Uints{},
                                   .failed = lists ? recorder.read(lists->state(), compute::AppendLists::failed_word) : Uints{},
                                   .irradiance = recorder.write(irradiance_), .first = first, .end = first + limit,
                                   .side_block = settings_.side << 8 | settings_.block, .count = settings_.picks, .map_size = map_size,
                                   .has_failed = lists != nullptr, .bound = bound_, .bias = bias, .reach2 = settings_.reach * settings_.reach},
                      gather_threads());
}

void PickPass::record_rays(engine::Recorder& recorder, const GBuffer& gbuffer, const compute::Bvh& bvh, float reach, const engine::Array<uint>& status) {
    assert(settings_.visibility == GatherVisibility::rays);
    // As GatherPass::max_vpls: a ray may take thousands of the loops that a device may allow an invocation.
    for (uint32_t first = 0; first < settings_.picks; first += 64) {
        BvhRef tree = bvh.read(recorder);
        tree.reach = reach;
        recorder.dispatch(gather_,
                          PickRaysPush{.gbuffer = gbuffer.read(recorder), .vpls = recorder.read(tree_.lights()), .picks = recorder.read(picks_),
                                       .irradiance = recorder.write(irradiance_), .bvh = tree, .status = recorder.write(status),
                                       .side_block_count = settings_.side << 24 | settings_.block << 16 | settings_.picks,
                                       .first_end = first << 16 | std::min(first + 64, settings_.picks), .bound = bound_,
                                       .reach2 = settings_.reach * settings_.reach},
                          gather_threads());
    }
}

}  // namespace myriad::passes
