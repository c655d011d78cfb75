#include "passes/gathering/gathering.hpp"

#include <algorithm>
#include <bit>

#include "passes/gathering/gathering_io.h"
#include "passes/kernels.hpp"

namespace myriad::passes {

namespace {

static_assert(compute::ViewTree::most_views <= 1u << gather_listed_bits, "a place has room in a listed light");

bool own_order(const GatheringSettings& settings) {
    return settings.visibility == GatherVisibility::maps && settings.maps.method == MapMethod::megaviews;
}

// Where there are no more lights than a pixel may gather, it gathers them all.
bool picks(const GatheringSettings& s) { return s.method != GatherMethod::subset && !s.far && !s.omni && s.subset < s.lights; }

GatheringSettings checked(GatheringSettings s) {
    if (s.method != GatherMethod::subset && !picks(s)) s.method = GatherMethod::subset, s.subset = 0;
    s.maps.parallel = s.far;
    s.maps.asks = s.maps.asks && own_order(s) && !picks(s);
    if (s.method == GatherMethod::subset) return s;
    if (s.lights > compute::ViewTree::most_views)
        throw InputError("a gather that picks from a tree takes up to " + std::to_string(compute::ViewTree::most_views) + " VPLs, and " +
                         std::to_string(s.lights) + " are asked for; lower --vpls");
    if (s.visibility == GatherVisibility::maps && s.maps.update != CutUpdate::basic)
        throw InputError("--gather culled and tree take VPLs in the order of a curve, which changes from frame to frame; --update incremental and lazy need the same VPLs in the "
                         "same places: give --update basic");
    return s;
}

}  // namespace

Gathering::Gathering(engine::Device& device, const GatheringSettings& settings, const engine::Constants& variant, const compute::WorldTriangles* world,
                     const IsmScene* ism)
    : settings_(checked(settings)), block_(picks(settings_) ? pick_block : gather_block(settings_.lights, settings_.subset)) {
    const GatheringSettings& s = settings_;
    const bool maps = s.visibility == GatherVisibility::maps, reorders = own_order(s) && !picks(s);
    if (picks(s))
        pick_.emplace(device,
                      PickSettings{.method = s.method == GatherMethod::culled ? PickMethod::culled : PickMethod::tree, .visibility = s.visibility, .width = s.width,
                                   .height = s.height, .vpls = s.lights, .picks = s.subset, .block = block_, .seed = s.seed, .glossy = s.glossy, .reach = s.distance},
                      variant);
    else gather_.emplace(device, s.visibility, s.width, s.height, variant, GatherKind{.glossy = s.glossy, .far = s.far, .listed = reorders, .omni = s.omni, .asks = s.maps.asks});
    if (picks(s) && !own_order(s)) views_.emplace(device, s.lights);
    if (s.filter && block_ > 1) filter_.emplace(device, s.width, s.height, s.glossy);
    if (maps) maps_.emplace(device, s.maps, s.lights, picks(s) ? 1 : block_ * block_, world, ism);
    if (reorders)
        reordering_.emplace(engine::Program(device, engine::passes_kernels, "gathering/reorder"), compute::Sort(device, s.lights, 32),
                            engine::Array<Vpl>(device, "vpls", "lights in the order of maps", s.lights),
                            engine::Array<uint>(device, "vpls", "sets of lights", s.lights), engine::Array<uint>(device, "vpls", "lights by set", s.lights));
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
    if (pick_) record_picked(recorder, in, exhausted, report);
    else record_sets(recorder, in, exhausted, report);
    if (!filter_) return;
    auto scope = recorder.scope("filter");
    filter_->record(recorder, in.gbuffer, gathered(), block_, pixel_angle);
}

// Batch by batch: maps, and gather(first, batch). `most`: lights at once, where there are no maps.
template <class Gather>
void Gathering::record_batches(engine::Recorder& recorder, const GatheringInputs& in, const engine::Array<View>& views, uint32_t most, Gather gather,
                               const std::function<void(double)>& report) {
    for (uint32_t first = 0; first < settings_.lights;) {
        const uint32_t batch = maps_ ? maps_->batch() : most;
        if (maps_) maps_->record(recorder, in.scene, views, in.count, first);
        {
            auto scope = recorder.scope("gather");
            gather(first, batch);
        }
        recorder.submit_and_wait();  // a batch a submission: progress, and no time-out on devices that watch
        if (!maps_ || maps_->accept()) first += batch;  // else the same again, with longer lists or fewer views
        report(std::min(1.0, double(first) / settings_.lights));
    }
}

void Gathering::record_sets(engine::Recorder& recorder, const GatheringInputs& in, const engine::Array<uint>& exhausted, const std::function<void(double)>& report) {
    const GatherInputs given{in.gbuffer, in.lights, in.count, block_, in.bound, settings_.far ? &in.views : nullptr};
    const GatherInputs reordered{in.gbuffer, reordering_ ? reordering_->lights : in.lights, in.count, block_, in.bound, nullptr, maps_ ? reorder(recorder, in) : nullptr,
                                 maps_ ? maps_->asked() : nullptr};
    const GatherInputs& gather = reordering_ ? reordered : given;
    gather_->clear(recorder);
    record_batches(recorder, in, in.views, gather_->max_vpls(block_), [&](uint32_t first, uint32_t batch) {
        if (settings_.visibility == GatherVisibility::rays) gather_->record_rays(recorder, gather, first, batch, in.bvh, in.reach, exhausted);
        else gather_->record_maps(recorder, gather, first, batch, atlas(), settings_.maps.map_size, settings_.bias, lists());
    }, report);
}

// Maps are drawn in the order of the tree, so that picks, in that order too, are gathered batch by batch.
void Gathering::record_picked(engine::Recorder& recorder, const GatheringInputs& in, const engine::Array<uint>& exhausted,
                              const std::function<void(double)>& report) {
    if (maps_) maps_->begin(recorder, in.scene, in.views, in.count);
    if (views_) {
        auto scope = recorder.scope("light tree");
        views_->record(recorder, in.views, in.count, in.scene.low, in.scene.high);
    }
    const compute::ViewTree& views = views_ ? *views_ : maps_->shared()->tree();
    pick_->record_picks(recorder, in.gbuffer, views, in.lights, in.count, in.bound);
    pick_->clear(recorder);
    record_batches(recorder, in, views.nodes(), settings_.lights, [&](uint32_t first, uint32_t batch) {
        if (settings_.visibility == GatherVisibility::rays) pick_->record_rays(recorder, in.gbuffer, in.bvh, in.reach, exhausted);
        else pick_->record_maps(recorder, in.gbuffer, first, batch, atlas(), settings_.maps.map_size, settings_.bias, lists());
    }, report);
}

}  // namespace myriad::passes
