// What many lights bring to each pixel, from their views to irradiance: maps batch by batch, gather, filter; see README.md.
#pragma once

#include <functional>
#include <optional>

#include "compute/sort/sort.hpp"
#include "passes/filter/filter.hpp"
#include "passes/gather/gather.hpp"
#include "passes/maps/maps.hpp"
#include "passes/pick/pick.hpp"

namespace myriad::passes {

// Which of the lights a pixel gathers.
enum class GatherMethod {
    subset,  // a set of them, another one for each pixel of a block (passes/gather)
    culled,  // some of those that may light its tile at all (passes/pick)
    tree,    // some, by what they may bring
};

struct GatheringSettings {
    GatherVisibility visibility = GatherVisibility::maps;
    uint32_t width = 0, height = 0;
    uint32_t lights = 0;      // there are at most so many
    GatherMethod method = GatherMethod::subset;
    uint32_t subset = 0;      // that each pixel gathers, about; 0, or as many as there are: all
    float distance = std::numeric_limits<float>::infinity();  // culled: metres that light reaches
    uint32_t seed = 1;        // culled, tree
    bool filter = true;       // blocks of pixels that gather subsets
    bool glossy = false;      // the G-buffer has gloss
    bool far = false;         // lights are far_light()s, their views parallel
    bool omni = false;        // lights are omni_light()s, their views see all around
    float bias = 0.5f;        // half diagonals of a texel
    MapSettings maps;         // visibility by maps
};

struct GatheringInputs {
    const GBuffer& gbuffer;
    const engine::Array<Vpl>& lights;
    const engine::Array<View>& views;     // maps
    const engine::Array<uint>& count;     // of lights and views, on the device
    float bound = 1e30f;                  // 1/m^2
    MapScene scene;                       // maps
    const compute::Bvh& bvh;              // rays, with the scene's largest absolute coordinate
    float reach = 0;
};

class Gathering {
public:
    // `variant`: specialisation constants of kernels that trace rays. `world`, `ism`: as ViewMaps.
    Gathering(engine::Device& device, const GatheringSettings& settings, const engine::Constants& variant, const compute::WorldTriangles* world,
              const IsmScene* ism);

    // What maps need when the scene has moved, and once before; and when the tree was built anew.
    void place(engine::Recorder& recorder, const MapScene& scene) { if (maps_) maps_->place(recorder, scene); }
    void forget() { if (maps_) maps_->forget(); }

    // Submits what was recorded, and its own work, and waits. `exhausted[0]` is set where a ray's walk met the device's limit on loops.
    // `report` hears how much is done, 0 to 1.
    void record(engine::Recorder& recorder, const GatheringInputs& in, float pixel_angle, const engine::Array<uint>& exhausted,
                const std::function<void(double)>& report);

    uint32_t block() const { return block_; }  // sets of lights are block x block
    // As GatherPass::irradiance().
    const engine::Array<vec4>& irradiance() const { return filter_ ? filter_->filtered() : gathered(); }
    const engine::Array<vec4>& gathered() const { return pick_ ? pick_->irradiance() : gather_->irradiance(); }  // before the filter
    std::optional<MapCounters> take_counters() { return maps_ ? std::optional(maps_->take_counters()) : std::nullopt; }

private:
    const engine::Array<uint>* reorder(engine::Recorder& recorder, const GatheringInputs& in);

    template <class Gather>
    void record_batches(engine::Recorder& recorder, const GatheringInputs& in, const engine::Array<View>& views, uint32_t most, Gather gather,
                        const std::function<void(double)>& report);
    void record_sets(engine::Recorder& recorder, const GatheringInputs& in, const engine::Array<uint>& exhausted, const std::function<void(double)>& report);
    void record_picked(engine::Recorder& recorder, const GatheringInputs& in, const engine::Array<uint>& exhausted, const std::function<void(double)>& report);

    const engine::Array<uint>* atlas() const { return maps_ ? &maps_->atlas() : nullptr; }
    const compute::AppendLists* lists() const { return maps_ ? maps_->lists() : nullptr; }

    GatheringSettings settings_;
    uint32_t block_;
    std::optional<GatherPass> gather_;
    std::optional<PickPass> pick_;             // in its place
    std::optional<compute::ViewTree> views_;   // that it picks from, where maps have none
    std::optional<FilterPass> filter_;
    std::optional<ViewMaps> maps_;
    // Where maps take views in an order of their own, lights go along, and are listed by the sets that they were in.
    struct Reordering {
        engine::Program reorder;
        compute::Sort sort;
        engine::Array<Vpl> lights;
        engine::Array<uint> sets, listed;
    };
    std::optional<Reordering> reordering_;
};

}  // namespace myriad::passes
