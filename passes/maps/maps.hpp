// The maps of many views, in as many batches as memory asks for; see README.md.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "compute/incremental/incremental.hpp"
#include "compute/manylods/manylods.hpp"
#include "compute/svo/svo.hpp"
#include "passes/brute/brute.hpp"
#include "passes/ism/ism.hpp"
#include "passes/maps/shared_maps.hpp"
#include "passes/splat/splat.hpp"

namespace myriad::passes {

// How a batch of maps is drawn.
enum class MapMethod {
    manylods,  // each view's cut through the BSH, splatted
    megaviews, // what is alike in many views is drawn once for all of them
    brute,     // all triangles, rasterised
    ism,       // few points of the surface, others in each view, and holes filled
};

// Where a frame's cuts start from (ManyLoDs 3.1 to 3.3).
enum class CutUpdate {
    basic,        // the roots
    incremental,  // the cuts of the frame before
    lazy,         // those, and only so many edges are walked down
};

struct MapSettings {
    compute::AppendMode append = compute::AppendMode::scan;
    uint32_t map_size = 32;   // texels a side of a half map
    float epsilon = 2;        // texels
    uint32_t views_at_once = 0;  // the most views a batch, or as many as it must have; 0: as many as fit. The same image
    uint32_t coverage = coverage_exact;  // manylods, megaviews: what nodes smaller than a texel cover (splat_io.h)
    MapMethod method = MapMethod::manylods;
    uint32_t shared_maps = 0; // megaviews: room for maps that views share, to begin with; 0: half as many as views, and 64
    bool asks = false;        // megaviews: views get no whole maps, look-ups ask what is shared as well (asked())
    IsmSettings ism;
    uint32_t seed = 1;        // ism
    CutUpdate update = CutUpdate::basic;
    uint32_t lazy_edges = 1;  // q of the paper, at least 1
    bool parallel = false;    // manylods: views are parallel ones (compute/views/parallel.h), all of them
    uint32_t arity = compute::bsh_arity_default;  // of the tree
    bool octree = false;      // megaviews: it is MapScene::octree that is drawn
    bool revalidate = false;  // incremental and lazy: every node-view in every frame, as the paper does
};

// What is drawn; a method needs but its own.
struct MapScene {
    const compute::Bsh* tree = nullptr;   // manylods, megaviews
    const compute::Svo* octree = nullptr; // in its place
    vec3 low{0}, high{0};                 // megaviews: a box that most views are in
    const Geometry* geometry = nullptr;   // brute, ism
};

struct MapCounters {
    uint64_t node_views = 0;  // tested
    uint64_t invalid = 0;     // lazy: node-views in the cuts that are larger than epsilon allows
    uint64_t cut = 0;         // node-views in the cuts, culled ones included
    uint64_t groups = 0;      // that hold them
    std::optional<uint64_t> maps_drawn;  // incremental and lazy: of all views, those that were not kept from the frame before
    uint64_t list_peak = 0, list_capacity = 0;  // items of the longest list, and what there was room for
    uint32_t batches = 0, redone = 0;
    uint64_t triangle_views = 0;  // brute: triangles, each in every view
    // megaviews: pairs of scene nodes and view nodes that were tested, and what became of them; views that the rendered ones stand for; maps of view
    // nodes with several views.
    uint64_t pairs = 0, pairs_culled = 0, pairs_edge_on = 0, pairs_rendered = 0, views_of_rendered = 0, shared_maps = 0;
    std::vector<compute::PairReport::Step> pair_steps;  // the same by step of the traversal

    MapCounters& operator+=(const MapCounters& other);
    void add_steps(const std::vector<compute::PairReport::Step>& steps);
};

class ViewMaps {
public:
    // `multiple`: batches start at multiples of this. Throws InputError for a map size that the device cannot draw, OutOfMemory
    // when not even one batch of `multiple` views fits.
    // `world`: the triangles, for brute; `ism`: for ism; they need not outlive the call.
    ViewMaps(engine::Device& device, const MapSettings& settings, uint32_t max_views, uint32_t multiple,
             const compute::WorldTriangles* world = nullptr, const IsmScene* ism = nullptr);

    // What must be done when the scene has moved, and once before the first batch: ism's points; the others' inputs are the caller's.
    void place(engine::Recorder& recorder, const MapScene& scene);

    // Once a frame, before its first batch. Returns the order that views are taken in from here on, by place: which view; null: as they are.
    const engine::Array<uint>* begin(engine::Recorder& recorder, const MapScene& scene, const engine::Array<View>& views, const engine::Array<uint>& count);

    // How many views go at once; can get smaller when accept() returns false.
    uint32_t batch() const { return batch_; }

    // Draws views [first, first + batch()) of those that exist, in begin()'s order.
    void record(engine::Recorder& recorder, const MapScene& scene, const engine::Array<View>& views, const engine::Array<uint>& count,
                uint32_t first);

    // After the submission: whether the lists sufficed. If not they are longer now, or the batch is smaller, and this batch must be
    // done again; a gather that was given lists() has left it out. Throws OutOfMemory when there is no way left.
    bool accept();

    const SharedMaps* shared() const { return shared_ ? &*shared_ : nullptr; }  // megaviews
    const engine::Array<uint>& atlas() const { return atlas_; }
    const engine::Array<SharedMap>* asked() const { return settings_.asks ? &shared_->asked() : nullptr; }  // by map
    const compute::AppendLists* lists() const { return lists_ ? &*lists_ : carried_now_ ? &carried_now_->lists() : nullptr; }  // null: the method has none, nothing overflows
    // For a tree that was built anew: cuts of the old one are forgotten.
    void forget() {
        atlas_of_ = nullptr;
        for (const auto& cut : carried_)
            if (cut) cut->restart();
        if (bounds_travel_) bounds_travel_->restart();
    }
    MapCounters take_counters() { return std::exchange(counters_, {}); }

private:
    void make_lists(uint64_t next, uint64_t kept);
    void make_carried(uint32_t index, uint64_t capacity);
    void grow(const compute::AppendReport& report);
    uint64_t list_bytes(uint64_t next, uint64_t kept) const;
    void make_atlas();
    bool has_lists() const { return settings_.method == MapMethod::manylods || settings_.method == MapMethod::megaviews; }
    bool is_handy(uint32_t views) const;
    void halve();
    uint64_t groups_guess(uint32_t views) const;

    engine::Device& device_;
    MapSettings settings_;
    uint32_t batch_, multiple_;
    // Of the method, the others do not exist.
    std::optional<compute::ManyLods> manylods_;
    std::optional<SplatPass> splat_;
    std::optional<compute::AppendLists> lists_;                  // basic
    std::vector<std::unique_ptr<compute::CarriedCut>> carried_;  // incremental and lazy: one a batch
    std::optional<compute::BoundsTravel> bounds_travel_;         // where the tree moves
    compute::CarriedCut* carried_now_ = nullptr;                 // of the batch that was recorded last
    const compute::CarriedCut* atlas_of_ = nullptr;              // whose maps the atlas holds
    bool keeps_ = false;                                         // whether the batch that was recorded last kept some
    std::optional<BrutePass> brute_;
    std::optional<IsmPass> ism_;
    std::optional<SharedMaps> shared_;
    uint32_t shared_maps_ = 0;                                   // of the atlas's maps, the last ones
    engine::Array<uint> atlas_;
    MapCounters counters_;
};

}  // namespace myriad::passes
