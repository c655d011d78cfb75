#include "passes/gathering/gathering.hpp"

#include <algorithm>
#include <bit>

#include "passes/gathering/gathering_io.h"
#include "passes/kernels.hpp"

namespace myriad::passes {

namespace {

// Pixels in a block's side so that each gathers about `subset` of the lights. A power of two: interleaved sets of that many are fair
// samples of the VPL sequence (passes/vpl).
uint32_t block_for(uint32_t lights, uint32_t subset) {
    uint32_t block = 1;
    while (subset > 0 && block < 16 && uint64_t(subset) * block * block < lights) block *= 2;
    return block;
}

static_assert(compute::ViewTree::most_views <= 1u << gather_listed_bits, "a place has room in a listed light");

bool own_order(const GatheringSettings& settings) {
    return settings.visibility == GatherVisibility::maps && settings.maps.method == MapMethod::megaviews;
}

}  // namespace

Gathering::Gathering(engine::Device& device, const GatheringSettings& settings, const engine::Constants& variant, const compute::WorldTriangles* world,
                     const IsmScene* ism)
    : settings_(settings), block_(block_for(settings.lights, settings.subset)),
      gather_(device, settings.visibility, settings.width, settings.height, variant, settings.glossy, settings.far, own_order(settings)) {
    settings_.maps.parallel = settings.far;
    if (settings.filter && block_ > 1) filter_.emplace(device, settings.width, settings.height, settings.glossy);
    if (settings.visibility == GatherVisibility::maps) maps_.emplace(device, settings_.maps, settings.lights, block_ * block_, world, ism);
    if (own_order(settings))
        reordering_.emplace(engine::Program(device, engine::passes_kernels, "gathering/reorder"), compute::Sort(device, settings.lights, 32),
                            engine::Array<Vpl>(device, "vpls", "lights in the order of maps", settings.lights),
                            engine::Array<uint>(device, "vpls", "sets of lights", settings.lights), engine::Array<uint>(device, "vpls", "lights by set", settings.lights));
}

// Null where the maps' order is the lights'.
const engine::Array<uint>* Gathering::reorder(engine::Recorder& recorder, const GatheringInputs& in) {
    const engine::Array<uint>* order = maps_->begin(recorder, in.scene, in.views, in.count);
    if (!order) return nullptr;
    Reordering& r = *reordering_;
    recorder.dispatch(r.reorder,
                      ReorderPush{.lights = recorder.read(in.lights), .count = recorder.read(in.count), .order = recorder.read(*order),
                                  .reordered = recorder.write(r.lights), .sets = recorder.write(r.sets), .listed = recorder.write(r.listed),
                                  .limit = settings_.lights, .sets_count = block_ * block_},
                      settings_.lights);
    return &r.sort.record(recorder, r.sets, r.listed, in.count, 0, uint32_t(std::bit_width(block_ * block_ - 1))).payload;
}

void Gathering::record(engine::Recorder& recorder, const GatheringInputs& in, float pixel_angle, const engine::Array<uint>& exhausted,
                       const std::function<void(double)>& report) {
    const GatherInputs given{in.gbuffer, in.lights, in.count, block_, in.bound, settings_.far ? &in.views : nullptr};
    const GatherInputs reordered{in.gbuffer, reordering_ ? reordering_->lights : in.lights, in.count, block_, in.bound, nullptr, maps_ ? reorder(recorder, in) : nullptr};
    const GatherInputs& gather = reordering_ ? reordered : given;
    gather_.clear(recorder);
    for (uint32_t first = 0; first < settings_.lights;) {
        const uint32_t batch = maps_ ? maps_->batch() : gather_.max_vpls(block_);
        if (maps_) maps_->record(recorder, in.scene, in.views, in.count, first);
        {
            auto scope = recorder.scope("gather");
            if (settings_.visibility == GatherVisibility::rays)
                gather_.record_rays(recorder, gather, first, batch, in.bvh, in.reach, exhausted);
            else
                gather_.record_maps(recorder, gather, first, batch, maps_ ? &maps_->atlas() : nullptr, settings_.maps.map_size, settings_.bias,
                                    maps_ ? maps_->lists() : nullptr);
        }
        recorder.submit_and_wait();  // a batch a submission: progress, and no time-out on devices that watch
        if (!maps_ || maps_->accept()) first += batch;  // else the same again, with longer lists or fewer views
        report(std::min(1.0, double(first) / settings_.lights));
    }
    if (!filter_) return;
    auto scope = recorder.scope("filter");
    filter_->record(recorder, in.gbuffer, gather_.irradiance(), block_, pixel_angle);
}

}  // namespace myriad::passes
