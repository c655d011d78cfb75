// `myriad bench gather`: what each pixel gathers of many VPLs whose maps are there: all, a subset, some of those that are not culled (MegaViews 5.1), or what a walk
// down the light tree picks. `ms` is what gathers take beside the maps: trees over lights, picks, gather and filter; `error` is that of the light that white diffuse
// surfaces reflect, against the gather of all VPLs from the same maps.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "compute/derived/derived.hpp"
#include "engine/transfer.hpp"
#include "passes/filter/filter.hpp"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/maps/maps.hpp"
#include "passes/pick/pick.hpp"
#include "passes/vpl/vpl.hpp"
#include "tools/bench/maps_bench.hpp"
#include "tools/metrics.hpp"

namespace myriad::tools {
namespace {

constexpr uint32_t width = 640, height = 360;

// One technique with one K, over all repetitions.
struct Gatherer {
    BenchRow row;
    uint32_t block = 1;
    std::optional<passes::GatherPass> gather;
    engine::Array<uint> listed;
    std::optional<passes::PickPass> pick;
    std::optional<passes::FilterPass> filter;
    std::vector<vec4> irradiance;

    const engine::Array<vec4>& result() const { return filter ? filter->filtered() : pick ? pick->irradiance() : gather->irradiance(); }
};

class Experiment {
public:
    Experiment(engine::Device& device, const BenchOptions& options)
        : device_(device), options_(options), still_(options, "builtin:atrium"), data_(passes::geometry_data(still_.scene, still_.triangles)),
          geometry_(device, still_.triangles, data_), table_(device, still_.scene, still_.triangles, data_), derived_(data_.world, nullptr),
          bvh_(derived_.bvh(device, compute::BvhQuality::quick, geometry_.opacity())), tree_(derived_.bsh(device, options.log2_samples, options.seed, options.arity)),
          gbuffer_(device, width, height, bvh_.constants()), recorder_(device) {
        if (tree_.empty()) throw InputError("\"" + still_.source + "\" has no surface to sample; give another --scene");
        if (table_.power() <= 0) throw InputError("\"" + still_.source + "\" has no light that makes VPLs; give another --scene");
        std::printf("scene: %s, %zu triangles, 2^%u samples, maps 2 x %u^2, epsilon %g, %u bounces, %ux%u\n", still_.source.c_str(), size_t(data_.world.count()), options.log2_samples,
                    options.map_size, options.epsilon, options.bounces, width, height);
        tree_.refit(recorder_, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
        gbuffer_.record(recorder_, geometry_, bvh_, still_.camera);
        recorder_.submit_and_wait();
        recorder_.take_times();
    }

    void run(uint32_t vpls, const RowSink& sink) {
        device_.reset_memory_peaks();
        passes::VplPass lights(device_, vpls, bvh_.constants());
        lights.prepare(recorder_, geometry_, bvh_, table_, options_.bounces, options_.seed);
        lights.record(recorder_, geometry_, bvh_, table_, options_.bounces, options_.seed);
        recorder_.submit_and_wait();
        const uint32_t alive = engine::download(device_, lights.count())[0];
        bound_ = float(std::min(3.14159265 * vpls / tree_.area(), 1e30));

        // Every map is drawn in the order of the tree; subsets list the VPLs of theirs.
        passes::ViewMaps maps(device_, {.map_size = options_.map_size, .epsilon = options_.epsilon, .method = passes::MapMethod::megaviews, .arity = options_.arity}, vpls, 1);
        maps.begin(recorder_, map_scene(), lights.views(), lights.count());
        recorder_.submit_and_wait();
        const compute::ViewTree& views = maps.shared()->tree();
        const std::vector<uint> order = engine::download(device_, views.order(), alive);
        ordered_ = {device_, "vpls", "lights along the curve", vpls};
        {
            const auto given = engine::download(device_, lights.vpls(), alive);
            std::vector<Vpl> along;
            for (uint i : order) along.push_back(given[i]);
            engine::upload_bytes(device_, along.data(), ordered_, along.size() * sizeof(Vpl));
        }
        std::vector<std::unique_ptr<Gatherer>> all;
        all.push_back(subset(vpls, 0, order));
        for (const char* technique : {"subset", "culled", "tree"})
            for (uint32_t k : options_.picks.empty() ? std::vector<uint32_t>{4, 16, 64, 256, 1024} : options_.picks) {
                if (k >= vpls) continue;
                all.push_back(*technique == 's' ? subset(vpls, k, order) : picked(technique, vpls, k));
            }
        for (uint32_t r = 0; r <= options_.repeats; ++r) measure_all(all, maps, lights, vpls, r > 0);

        for (auto& g : all) g->irradiance = engine::download(device_, g->result(), uint64_t(width) * height);
        for (auto& g : all) {
            g->row.error["relMSE"] = white_error(all[0]->irradiance, g->irradiance, width, height);
            g->row.counters["vpls"] = alive;
            set_bytes(g->row, device_);
        }
        compare(all);
        for (auto& g : all) sink(g->row);
    }

private:
    passes::MapScene map_scene() const { return {.tree = &tree_, .low = still_.triangles.lo, .high = still_.triangles.hi, .geometry = &geometry_}; }

    std::unique_ptr<Gatherer> begin(const char* technique, uint32_t vpls, uint32_t k, uint32_t block) {
        auto g = std::make_unique<Gatherer>();
        g->block = block;
        g->row.bench = "gather";
        g->row.scene = still_.name();
        g->row.technique = technique;
        g->row.views = vpls;
        g->row.settings = {{"bounces", options_.bounces}, {"map_size", options_.map_size}, {"epsilon", options_.epsilon}, {"block", block}, {"width", width}, {"height", height}};
        if (k) g->row.settings["k"] = k;
        if (block > 1) g->filter.emplace(device_, width, height);
        return g;
    }
    std::unique_ptr<Gatherer> subset(uint32_t vpls, uint32_t k, const std::vector<uint>& order) {
        const uint32_t block = passes::gather_block(vpls, k), sets = block * block;
        auto g = begin(k ? "subset" : "all", vpls, k, block);
        std::vector<uint> listed;
        for (uint i = 0; i < order.size(); ++i) listed.push_back(order[i] % sets << gather_listed_bits | i);
        std::ranges::sort(listed);
        g->listed = engine::upload(device_, "vpls", "lights by set", listed);
        g->gather.emplace(device_, passes::GatherVisibility::maps, width, height, engine::Constants{}, passes::GatherKind{.listed = true});
        return g;
    }
    std::unique_ptr<Gatherer> picked(const char* technique, uint32_t vpls, uint32_t k) {
        const passes::PickSettings settings{.method = *technique == 'c' ? passes::PickMethod::culled : passes::PickMethod::tree, .width = width, .height = height, .vpls = vpls,
                                            .picks = k, .block = passes::pick_block, .seed = options_.seed};
        auto g = begin(technique, vpls, k, settings.block);
        g->pick.emplace(device_, settings);
        return g;
    }

    void measure_all(std::vector<std::unique_ptr<Gatherer>>& all, passes::ViewMaps& maps, const passes::VplPass& lights, uint32_t vpls, bool counts) {
        std::vector<std::map<std::string, double>> stages(all.size());
        const auto take = [&](std::map<std::string, double>* into) {
            for (const engine::PassTime& t : recorder_.take_times())
                if (into) (*into)[t.name] += t.gpu_ms;
        };
        std::map<std::string, double> view_tree;
        maps.begin(recorder_, map_scene(), lights.views(), lights.count());
        recorder_.submit_and_wait();
        take(&view_tree);
        for (size_t i = 0; i < all.size(); ++i) {
            if (!all[i]->pick) {
                all[i]->gather->clear(recorder_);
                continue;
            }
            all[i]->pick->record_picks(recorder_, gbuffer_.gbuffer(), maps.shared()->tree(), lights.vpls(), lights.count(), bound_);
            all[i]->pick->clear(recorder_);
            recorder_.submit_and_wait();
            stages[i] = view_tree;
            take(&stages[i]);
        }
        for (uint32_t first = 0; first < vpls;) {
            const uint32_t batch = maps.batch();
            maps.record(recorder_, map_scene(), lights.views(), lights.count(), first);
            recorder_.submit_and_wait();
            take(nullptr);
            if (!maps.accept()) continue;
            for (size_t i = 0; i < all.size(); ++i) {
                Gatherer& g = *all[i];
                {
                    auto scope = recorder_.scope("gather");
                    if (g.pick) g.pick->record_maps(recorder_, gbuffer_.gbuffer(), first, batch, &maps.atlas(), options_.map_size, bias);
                    else g.gather->record_maps(recorder_, {gbuffer_.gbuffer(), ordered_, lights.count(), g.block, bound_, nullptr, &g.listed}, first, batch, &maps.atlas(), options_.map_size, bias);
                }
                recorder_.submit_and_wait();
                take(&stages[i]);
            }
            first += batch;
        }
        for (size_t i = 0; i < all.size(); ++i) {
            if (all[i]->filter) {
                auto scope = recorder_.scope("filter");
                all[i]->filter->record(recorder_, gbuffer_.gbuffer(), all[i]->pick ? all[i]->pick->irradiance() : all[i]->gather->irradiance(), all[i]->block,
                                       2 * std::tan(still_.camera.yfov / 2) / float(height));
            }
            recorder_.submit_and_wait();
            take(&stages[i]);
            if (!counts) continue;
            double total = 0;
            for (const auto& [name, ms] : stages[i]) all[i]->row.stages[name].ms.push_back(ms), total += ms;
            all[i]->row.ms.ms.push_back(total);
        }
    }

    // What a technique needs for an error, between its rows on logarithmic axes; nothing beyond them.
    static std::optional<double> ms_at(const std::vector<std::unique_ptr<Gatherer>>& all, const char* technique, double error) {
        std::optional<double> best;
        const BenchRow* last = nullptr;
        for (const auto& g : all) {
            if (g->row.technique != technique) continue;
            if (last) {
                const double e0 = last->error.at("relMSE"), e1 = g->row.error.at("relMSE"), t0 = last->ms.median(), t1 = g->row.ms.median();
                if (error <= e0 && error >= e1 && e1 < e0 && e1 > 0) {
                    const double ms = t0 * std::pow(t1 / t0, std::log(error / e0) / std::log(e1 / e0));
                    best = std::min(best.value_or(ms), ms);
                }
            }
            last = &g->row;
        }
        return best;
    }
    static void compare(std::vector<std::unique_ptr<Gatherer>>& all) {
        for (auto& g : all)
            for (const char* other : {"culled", "subset"})
                if (g->row.technique == "tree")
                    if (const auto ms = ms_at(all, other, g->row.error.at("relMSE"))) g->row.counters[std::string("of_") + other + "_ms"] = g->row.ms.median() / *ms;
    }

    static constexpr float bias = 0.5f;
    engine::Device& device_;
    const BenchOptions& options_;
    StillScene still_;
    passes::GeometryData data_;
    passes::Geometry geometry_;
    passes::LightTable table_;
    compute::Derived derived_;
    compute::Bvh bvh_;
    compute::Bsh tree_;
    passes::GBufferPass gbuffer_;
    engine::Recorder recorder_;
    engine::Array<Vpl> ordered_;
    float bound_ = 0;
};

}  // namespace

void bench_gather(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    Experiment experiment(device, options);
    for (const uint32_t vpls : options.views.empty() ? std::vector<uint32_t>{4096} : options.views) experiment.run(vpls, sink);
}

}  // namespace myriad::tools
