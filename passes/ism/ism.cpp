#include "passes/ism/ism.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {

using engine::passes_kernels;

namespace {

engine::Constants constants(const compute::WorldTriangles& world) {
    engine::Constants constants = world.constants();
    constants[2] = world.opacity.blends();
    return constants;
}

// A point next to the view may cover a whole map: where loops are limited, an invocation draws few.
uint32_t points_a_thread(const engine::Device& device) { return device.loop_limit() == ~0u ? 8 : 1; }

}  // namespace

IsmPass::IsmPass(engine::Device& device, const IsmScene& scene, const IsmSettings& settings, uint32_t seed)
    : device_(device), settings_(settings), seed_(seed), blends_(scene.world.opacity.blends()),
      place_(device, passes_kernels, "ism/points", constants(scene.world)),
      splat_(device, passes_kernels, "ism/splat", {{2, points_a_thread(device)}}), pull_(device, passes_kernels, "ism/pull"),
      push_(device, passes_kernels, "ism/push"),
      samples_(engine::upload(device, "scene", "samples", scene.sampling.samples)),
      points_(device, "scene", "ISM points", scene.sampling.samples.size()) {
    settings_.points = uint32_t(std::min<uint64_t>(settings.points, scene.sampling.samples.size()));
    radius_ = settings_.points ? float(settings.cover * std::sqrt(scene.sampling.area / (settings_.points * std::numbers::pi))) : 0;
    threshold_ = settings.threshold * scene.extent;
}

void IsmPass::place(engine::Recorder& recorder, const Geometry& geometry) {
    if (points_.count() == 0) return;
    recorder.dispatch(place_,
                      IsmPointsPush{.geometry = geometry.read(recorder),
                                    .opacity = blends_ ? geometry.opacity()(recorder) : OpacityRef{},
                                    .samples = recorder.read(samples_),
                                    .points = recorder.write(points_),
                                    .count = uint(points_.count())},
                      points_.count());
}

void IsmPass::record(engine::Recorder& recorder, const engine::Array<View>& views, const engine::Array<uint>& count, uint32_t first,
                     uint32_t limit, uint32_t map_size, const engine::Array<uint>& atlas) {
    recorder.fill(atlas, atlas_nothing);
    if (settings_.points == 0) return;
    const uint32_t workgroup = splat_.workgroup_size(), a_group = workgroup * points_a_thread(device_);
    const uint32_t groups = (settings_.points + a_group - 1) / a_group;
    recorder.dispatch(splat_,
                      IsmSplatPush{.points = recorder.read(points_),
                                   .views = recorder.read(views),
                                   .count = recorder.read(count),
                                   .atlas = recorder.write(atlas),
                                   .samples = uint(points_.count()),
                                   .subset = settings_.points,
                                   .radius = radius_,
                                   .seed = seed_,
                                   .first_view = first,
                                   .limit = limit,
                                   .groups_a_view = groups,
                                   .map_size = map_size},
                      uint64_t(limit) * groups * workgroup);

    std::vector<uint32_t> sizes{map_size};
    while (sizes.size() <= settings_.levels && sizes.back() > 1) sizes.push_back(ism_coarser(sizes.back()));
    levels_.resize(sizes.size() - 1);
    const auto level = [&](size_t l) -> const engine::Array<uint>& { return l == 0 ? atlas : levels_[l - 1]; };
    const auto push = [&](size_t l) {
        return IsmLevelPush{.fine_size = sizes[l], .coarse_size = sizes[l + 1], .halves = 2 * limit, .threshold = std::ldexp(threshold_, int(l))};
    };
    for (size_t l = 0; l + 1 < sizes.size(); ++l) {
        const uint64_t words = uint64_t(limit) * map_texels(sizes[l + 1]);
        if (levels_[l].count() < words) levels_[l] = {device_, "atlas", "ISM pyramid", words};
        IsmLevelPush pull = push(l);
        pull.fine = recorder.read(level(l)), pull.coarse = recorder.write(level(l + 1));
        recorder.dispatch(pull_, pull, words);
    }
    for (size_t l = sizes.size() - 1; l-- > 0;) {
        IsmLevelPush fill = push(l);
        fill.fine = recorder.write(level(l)), fill.coarse = recorder.read(level(l + 1));
        recorder.dispatch(push_, fill, uint64_t(limit) * map_texels(sizes[l]));
    }
}

}  // namespace myriad::passes
