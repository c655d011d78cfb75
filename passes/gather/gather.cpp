#include "passes/gather/gather.hpp"

#include <algorithm>

#include "passes/kernels.hpp"

namespace myriad::passes {

using engine::passes_kernels;

namespace {

engine::Program program(engine::Device& device, GatherVisibility visibility, engine::Constants variant, const GatherKind& kind) {
    variant[glossy_constant] = kind.glossy;
    variant[parallel_constant] = kind.far;
    variant[gather_omni_constant] = kind.omni;
    if (visibility == GatherVisibility::rays) return {device, passes_kernels, "gather/rays", variant};
    return {device, passes_kernels, "gather/maps",
            {{2, visibility == GatherVisibility::maps}, {glossy_constant, kind.glossy}, {parallel_constant, kind.far}, {gather_listed_constant, kind.listed},
             {gather_omni_constant, kind.omni}, {gather_asks_constant, kind.asks}}};
}

}  // namespace

uint32_t gather_block(uint32_t lights, uint32_t subset) {
    uint32_t block = 1;
    while (subset > 0 && block < 16 && uint64_t(subset) * block * block < lights) block *= 2;
    return block;
}

GatherPass::GatherPass(engine::Device& device, GatherVisibility visibility, uint32_t width, uint32_t height,
                       const engine::Constants& variant, const GatherKind& kind)
    : device_(device), visibility_(visibility), program_(program(device, visibility, variant, kind)),
      irradiance_(device, "images", "irradiance", uint64_t(width) * height * (kind.glossy ? 2 : 1)) {}

uint32_t GatherPass::max_vpls(uint32_t block) const {
    // A ray may take thousands of loop iterations, a map look-up takes the one of its VPL.
    const uint64_t a_set = visibility_ == GatherVisibility::rays ? 64 : std::min<uint32_t>(device_.loop_limit() - 8, 1 << 16);
    return uint32_t(std::min<uint64_t>(a_set * block * block, 1u << 30));
}

uint64_t GatherPass::threads(const GatherInputs& in) const {
    const uint32_t size = program_.workgroup_size();
    return uint64_t(gather_groups_a_set(in.gbuffer.width, in.gbuffer.height, in.block, size)) * size * in.block * in.block;
}

void GatherPass::record_maps(engine::Recorder& recorder, const GatherInputs& in, uint32_t first, uint32_t limit,
                             const engine::Array<uint>* atlas, uint32_t map_size, float bias,
                             const compute::AppendLists* lists) {
    assert(first % (in.block * in.block) == 0 && (visibility_ == GatherVisibility::none) == (atlas == nullptr));
    for (uint32_t done = 0, part = max_vpls(in.block); done < limit; done += part)
        recorder.dispatch(program_,
                          GatherPush{.gbuffer = in.gbuffer.read(recorder),
                                     .vpls = recorder.read(in.vpls),
                                     .count = recorder.read(in.count),
                                     .atlas = atlas ? recorder.read(*atlas) : Uints{},
                                     .failed = lists ? recorder.read(lists->state(), compute::AppendLists::failed_word) : Uints{},
                                     .views = atlas && in.views ? recorder.read(*in.views) : Views{},
                                     .irradiance = recorder.write(irradiance_),
                                     .first = first + done,
                                     .limit = std::min(part, limit - done),
                                     .sides = gather_sides(in.block, map_size, lists != nullptr),
                                     .first_map = first,
                                     .bound = in.bound,
                                     .bias = bias,
                                     .asked = in.asked ? recorder.read(*in.asked) : SharedMapArray{},
                                     .listed = in.listed ? recorder.read(*in.listed) : Uints{}},
                          threads(in));
}

void GatherPass::record_rays(engine::Recorder& recorder, const GatherInputs& in, uint32_t first, uint32_t limit, const compute::Bvh& bvh,
                             float reach, const engine::Array<uint>& status) {
    assert(visibility_ == GatherVisibility::rays && first % (in.block * in.block) == 0);
    const auto tree = [&] {
        BvhRef ref = bvh.read(recorder);
        ref.reach = reach;
        return ref;
    };
    for (uint32_t done = 0, part = max_vpls(in.block); done < limit; done += part)
        recorder.dispatch(program_,
                          GatherRaysPush{.gbuffer = in.gbuffer.read(recorder),
                                         .vpls = recorder.read(in.vpls),
                                         .count = recorder.read(in.count),
                                         .irradiance = recorder.write(irradiance_),
                                         .bvh = tree(),
                                         .status = recorder.write(status),
                                         .first = first + done,
                                         .limit = std::min(part, limit - done),
                                         .block = in.block,
                                         .bound = in.bound},
                          threads(in));
}

}  // namespace myriad::passes
