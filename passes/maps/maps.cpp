#include "passes/maps/maps.hpp"

#include <algorithm>

namespace myriad::passes {

using compute::AppendLists;

namespace {

uint32_t round_up(uint32_t value, uint32_t multiple) { return (value + multiple - 1) / multiple * multiple; }

engine::Constants kind_of(const MapSettings& settings) {
    engine::Constants constants = settings.octree ? compute::Svo::constants() : compute::bsh_constants(settings.arity);
    constants[parallel_constant] = settings.parallel;
    constants[coverage_constant] = settings.coverage;
    return constants;
}

uint64_t atlas_words(uint32_t views, uint32_t map_size) { return uint64_t(views) * map_texels(map_size); }

}  // namespace

MapCounters& MapCounters::operator+=(const MapCounters& other) {
    node_views += other.node_views, invalid += other.invalid, cut += other.cut, groups += other.groups;
    list_peak = std::max(list_peak, other.list_peak), list_capacity = std::max(list_capacity, other.list_capacity);
    batches += other.batches, redone += other.redone, triangle_views += other.triangle_views;
    pairs += other.pairs, pairs_culled += other.pairs_culled, pairs_edge_on += other.pairs_edge_on, pairs_rendered += other.pairs_rendered, views_of_rendered += other.views_of_rendered;
    shared_maps += other.shared_maps;
    add_steps(other.pair_steps);
    if (other.maps_drawn) maps_drawn = maps_drawn.value_or(0) + *other.maps_drawn;
    return *this;
}

void MapCounters::add_steps(const std::vector<compute::PairReport::Step>& steps) {
    pair_steps.resize(std::max(pair_steps.size(), steps.size()));
    for (size_t i = 0; i < steps.size(); ++i) pair_steps[i] += steps[i];
}

ViewMaps::ViewMaps(engine::Device& device, const MapSettings& settings, uint32_t max_views, uint32_t multiple, const compute::WorldTriangles* world,
                   const IsmScene* ism)
    : device_(device), settings_(settings), batch_(round_up(std::max(settings.views_at_once ? std::min(max_views, settings.views_at_once) : max_views, 1u), multiple)),
      multiple_(multiple) {
    assert(!settings.asks || settings.method == MapMethod::megaviews);
    assert(!settings.parallel || settings.method == MapMethod::manylods);
    assert(!settings.octree || settings.method == MapMethod::megaviews);
    SplatPass::check_map_size(device, settings.map_size);
    // Before the atlas, which takes its share of what memory they leave.
    if (settings.method == MapMethod::brute) brute_.emplace(device, *world);
    if (settings.method == MapMethod::ism) ism_.emplace(device, *ism, settings.ism, settings.seed);
    if (settings.method == MapMethod::megaviews) shared_.emplace(device, std::max(max_views, 1u), kind_of(settings), settings.asks);
    while (batch_ > multiple_ && !is_handy(batch_)) halve();
    make_atlas();
    if (!has_lists()) return;
    if (settings.method == MapMethod::manylods) {
        splat_.emplace(device, kind_of(settings));
        if (settings.update != CutUpdate::basic) return;  // lists come with the first frame, one a batch
        manylods_.emplace(device, kind_of(settings));
    }
    const uint64_t affordable = device_.memory_free() / 2 / (4 * sizeof(uvec2));
    const uint64_t kept = std::min({groups_guess(batch_), affordable, AppendLists::max_capacity});
    make_lists(std::max<uint64_t>(kept - kept / 4, batch_), std::max<uint64_t>(kept, 1));
}

// Batches as small as still keep a device busy: lists of some 64 MiB, and maps that stay in caches. An atlas may take half of what
// memory is left, and an index into it has 32 bits.
bool ViewMaps::is_handy(uint32_t views) const {
    const uint64_t words = atlas_words(views, settings_.map_size);
    return words >> 32 == 0 && words * sizeof(uint) <= device_.memory_free() / 2 && (!has_lists() || groups_guess(views) <= 1 << 23);
}

// A batch that does not fit is done again with longer lists, so the guess need not be safe. Measured: up to 1.16 groups a texel at an
// epsilon of 2 texels (Sponza, nave) and 1.6 at 1, in Sponza and the atrium; the number falls with the square of epsilon.
uint64_t ViewMaps::groups_guess(uint32_t views) const {
    const double epsilon = std::clamp(settings_.epsilon, 0.5f, 16.0f);
    const double a_texel = shared_ ? 1.25 : 5.0;  // views that share have fewer groups, and want larger batches: each batch goes through all maps above its views
    return std::max<uint64_t>(uint64_t(a_texel / (epsilon * epsilon) * double(atlas_words(views, settings_.map_size))), 4096);
}

void ViewMaps::halve() { batch_ = round_up(batch_ / 2, multiple_); }

void ViewMaps::make_atlas() {
    atlas_ = {};
    // A guess where none is given (measured: 0.2 to 0.4 a view); see grow().
    if (shared_ && shared_maps_ == 0) shared_maps_ = settings_.shared_maps ? settings_.shared_maps : batch_ / 2 + 64;
    atlas_ = {device_, "atlas", "atlas", atlas_words(batch_ + shared_maps_, settings_.map_size)};
}

const engine::Array<uint>* ViewMaps::begin(engine::Recorder& recorder, const MapScene& scene, const engine::Array<View>& views,
                                           const engine::Array<uint>& count) {
    if (!shared_) return nullptr;
    auto scope = recorder.scope("view tree");
    shared_->begin(recorder, views, count, scene.low, scene.high);
    return &shared_->order();
}

void ViewMaps::make_lists(uint64_t next, uint64_t kept) {
    lists_.reset();
    lists_.emplace(device_, settings_.append, next, kept);
}

// Views [index * batch, …) and what their cuts are carried in.
void ViewMaps::make_carried(uint32_t index, uint64_t capacity) {
    if (carried_.size() <= index) carried_.resize(index + 1);
    carried_[index].reset();
    carried_[index] = std::make_unique<compute::CarriedCut>(device_, settings_.append, capacity, index * batch_, batch_, kind_of(settings_));
}

void ViewMaps::record(engine::Recorder& recorder, const MapScene& scene, const engine::Array<View>& views, const engine::Array<uint>& count,
                      uint32_t first) {
    if (ism_) {
        auto scope = recorder.scope("ism");
        ism_->record(recorder, views, count, first, batch_, settings_.map_size, atlas_);
        return;
    }
    if (brute_) {
        auto scope = recorder.scope("brute");
        brute_->record(recorder, *scene.geometry, views, count, first, batch_, settings_.map_size, atlas_);
        return;
    }
    if (shared_) {
        const compute::SceneTree& drawn = settings_.octree ? static_cast<const compute::SceneTree&>(*scene.octree) : *scene.tree;
        return shared_->record(recorder, *lists_, drawn, count, first, batch_, settings_.epsilon, settings_.map_size, atlas_, batch_ + shared_maps_);
    }
    const compute::Bsh& tree = *scene.tree;
    const compute::ManyLodsInputs cut{tree, views, count, first, batch_, settings_.epsilon, settings_.map_size};
    if (manylods_) {
        auto scope = recorder.scope("cut");
        manylods_->record(recorder, *lists_, cut);
    } else {
        const uint32_t index = first / batch_;
        if (carried_.size() <= index || !carried_[index]) {
            const uint64_t affordable = device_.memory_free() / 2 / (compute::CarriedCut::bytes(device_, settings_.append, 1024, 0) / 1024);
            make_carried(index, std::max<uint64_t>(std::min({groups_guess(batch_), affordable, AppendLists::max_capacity}), batch_));
        }
        carried_now_ = carried_[index].get();
        auto scope = recorder.scope("cut");
        if (tree.moving_blocks() > 0) {
            if (!bounds_travel_) bounds_travel_.emplace(device_, settings_.arity);
            bounds_travel_->record(recorder, tree);
        }
        carried_now_->record(recorder, cut, {.everything = settings_.revalidate, .edges = settings_.update == CutUpdate::lazy ? settings_.lazy_edges : 0},
                             bounds_travel_ ? &*bounds_travel_ : nullptr);
    }
    auto scope = recorder.scope("splat");
    keeps_ = carried_now_ && atlas_of_ == carried_now_;
    splat_->record(recorder, {*lists(), tree, views, first, settings_.map_size, keeps_ ? &carried_now_->changed() : nullptr}, atlas_);
    atlas_of_ = carried_now_;
}

void ViewMaps::place(engine::Recorder& recorder, const MapScene& scene) {
    if (ism_) ism_->place(recorder, *scene.geometry);
}

bool ViewMaps::accept() {
    if (!lists()) return ++counters_.batches;
    const compute::AppendReport report = lists()->report();
    counters_.list_peak = std::max({counters_.list_peak, report.next_needed, report.kept_needed});
    counters_.list_capacity = std::max(lists()->next_capacity(), lists()->kept_capacity());
    if (!report.ok()) return grow(report), false;
    ++counters_.batches;
    counters_.groups += report.kept;
    if (shared_) {
        const compute::PairReport found = shared_->pairs();
        const compute::PairReport::Step& pairs = found.total;
        counters_.add_steps(found.steps);
        counters_.pairs += pairs.tested, counters_.pairs_culled += pairs.culled, counters_.pairs_edge_on += pairs.edge_on, counters_.pairs_rendered += pairs.rendered;
        counters_.views_of_rendered += pairs.shared, counters_.shared_maps += shared_->shared_needed();
        return true;
    }
    counters_.node_views += report.processed;
    if (!carried_now_) {
        counters_.cut += report.processed - report.opened;
        return true;
    }
    const compute::CarryReport carried = carried_now_->report();
    counters_.cut += carried.cut;
    counters_.maps_drawn = counters_.maps_drawn.value_or(0) + (keeps_ ? carried.changed : batch_);
    counters_.invalid += carried.invalid;
    return true;
}

uint64_t ViewMaps::list_bytes(uint64_t next, uint64_t kept) const {
    return carried_now_ ? compute::CarriedCut::bytes(device_, settings_.append, kept, batch_) : AppendLists::bytes(device_, settings_.append, next, kept);
}

// Longer lists, or fewer views at once, for what `report` says was missing.
void ViewMaps::grow(const compute::AppendReport& report) {
    ++counters_.redone;
    atlas_of_ = nullptr;
    if (report.caller_overflowed && !report.next_overflowed && !report.kept_overflowed) {
        const uint32_t wanted = shared_->shared_needed() + shared_->shared_needed() / 4;
        const uint64_t words = atlas_words(batch_ + wanted, settings_.map_size);
        if (words >> 32 == 0 && words * sizeof(uint) <= device_.memory_free() + atlas_.bytes()) return shared_maps_ = wanted, make_atlas();
        if (batch_ > multiple_) return halve(), shared_maps_ = 0, make_atlas();
        throw OutOfMemory("the maps of " + std::to_string(batch_) + " views and those that they share need " + std::to_string((words >> 18) + 1) +
                          " MiB, which --memory-limit does not leave; raise it, or lower --map-size");
    }
    // A quarter more than was needed: the next frame's need differs, and an overflowed step hides what came after it.
    auto grown = [](uint64_t needed, uint64_t capacity) { return needed > capacity ? needed + needed / 4 : capacity; };
    uint64_t next = grown(report.next_needed, lists()->next_capacity());
    uint64_t kept = grown(report.kept_needed, lists()->kept_capacity());
    if (carried_now_) next = kept = std::max(next, kept);
    const uint64_t old = list_bytes(lists()->next_capacity(), lists()->kept_capacity()), need = list_bytes(next, kept);
    // The lists' counters and the scan's upper levels come on top.
    const bool fits = std::max(next, kept) <= AppendLists::max_capacity && need + need / 256 + 4096 <= device_.memory_free() + old;
    if (fits && carried_now_) {
        for (uint32_t i = 0; i < carried_.size(); ++i)
            if (carried_[i].get() == carried_now_) return carried_now_ = nullptr, make_carried(i, kept);
    } else if (fits) {
        make_lists(next, kept);
    } else if (!carried_now_ && batch_ > multiple_) {
        halve();
        shared_maps_ = 0;
        make_atlas();
    } else {
        throw OutOfMemory("the lists of " + std::to_string(batch_) + " views need " + std::to_string((need >> 20) + 1) +
                          " MiB, which --memory-limit does not leave; raise it, or lower --map-size, or raise --epsilon" +
                          (carried_now_ ? ", or give --update basic, which keeps the cuts of one batch of views only" : ""));
    }
}

}  // namespace myriad::passes
