// `myriad bench megaviews-views`: Figure 10 of MegaViews. Maps of more and more views, of VPLs of one bounce and of four, and at random places (Figure 11):
// what is drawn once for many views against what is drawn for each, ManyLoDs and all triangles, which are `extrapolated` in proportion to views beyond what
// is measured. `ms` is what the maps take and nothing else; `error` is that of indirect light gathered by the same maps, against exact rays to the same lights.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "compute/derived/derived.hpp"
#include "engine/transfer.hpp"
#include "passes/gathering/gathering.hpp"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/vpl/vpl.hpp"
#include "tools/bench/maps_bench.hpp"
#include "tools/metrics.hpp"
#include "tools/output_file.hpp"
#include "tools/plot.hpp"

namespace myriad::tools {
namespace {

using passes::MapMethod;

constexpr double fit_from = 65536;          // views: the exponent is fitted from here on
constexpr uint32_t most_brute = 1024;       // views that all triangles are drawn for; where all numbers are larger they are left out
constexpr uint32_t most_compared = 4096;    // views of which irradiance is gathered
constexpr uint32_t width = 64, height = 36; // pixels that gather it

struct Distribution {
    const char* name;
    uint32_t bounces;  // 0: no VPLs, random places
};
const Distribution distributions[] = {{"1-bounce", 1}, {"4-bounce", 4}, {"random", 0}};

struct Technique {
    const char* name;
    MapMethod method;
    const char* colours[std::size(distributions)];
};
// Before MegaViews the one that it is held against.
const Technique techniques[] = {
    {"brute", MapMethod::brute, {"#444444", "#888888", "#bbbbbb"}},
    {"manylods", MapMethod::manylods, {"#993404", "#d95f0e", "#fe9929"}},
    {"megaviews", MapMethod::megaviews, {"#08306b", "#2171b5", "#6baed6"}},
};

// Of the scene, what all rows share. Its parts refer to one another.
struct Setting : StillScene {
    explicit Setting(const BenchOptions& options) : StillScene(options, "builtin:atrium"), data(passes::geometry_data(scene, triangles)) {}

    passes::GeometryData data;
};

// The slope of log ms over log views, least squares.
double exponent(const std::vector<Plot::Point>& points) {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const Plot::Point& p : points) x += std::log(p.x), y += std::log(p.y), xx += std::log(p.x) * std::log(p.x), xy += std::log(p.x) * std::log(p.y);
    const double n = double(points.size());
    return (n * xy - x * y) / (n * xx - x * x);
}

// Of one distribution and number.
struct Lights {
    std::optional<passes::VplPass> vpls;
    engine::Array<Vpl> random_vpls;
    engine::Array<View> random_views;
    engine::Array<uint> random_count;
    uint32_t alive = 0;
    const engine::Array<Vpl>& lights() const { return vpls ? vpls->vpls() : random_vpls; }
    const engine::Array<View>& views() const { return vpls ? vpls->views() : random_views; }
    const engine::Array<uint>& count() const { return vpls ? vpls->count() : random_count; }
};

class Experiment {
public:
    Experiment(engine::Device& device, const BenchOptions& options, const Setting& setting, const RowSink& sink)
        : device_(device), options_(options), setting_(setting), sink_(sink), geometry_(device, setting.triangles, setting.data),
          table_(device, setting.scene, setting.triangles, setting.data), derived_(setting.data.world, nullptr),
          bvh_(derived_.bvh(device, compute::BvhQuality::quick, geometry_.opacity())),
          tree_(derived_.bsh(device, options.log2_samples, options.seed, options.arity)), gbuffer_(device, width, height, bvh_.constants()) {
        if (tree_.empty()) throw InputError("\"" + setting.source + "\" has no surface to sample; give another --scene");
        if (table_.power() <= 0) throw InputError("\"" + setting.source + "\" has no light that makes VPLs; give another --scene");
        engine::Recorder recorder(device);
        tree_.refit(recorder, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
        gbuffer_.record(recorder, geometry_, bvh_, setting.camera);
        recorder.submit_and_wait();
        if (options.levels.empty()) return;
        octree_.emplace(device, derived_.world(), options.levels[0], setting.triangles.lo, setting.triangles.hi);
        octree_->build(recorder, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
        octree_->settle();
    }

    void run(const Distribution& distribution, const std::vector<uint32_t>& counts) {
        const size_t d = size_t(&distribution - distributions);
        std::map<std::string, BenchRow> largest;  // that was measured, by technique
        std::map<std::string, Plot::Line> lines;
        for (const uint32_t count : counts) {
            const Lights lights = make_lights(distribution, count);
            const std::vector<vec4> reference = count == counts.front() && count <= most_compared ? irradiance(lights, nullptr, count) : std::vector<vec4>();
            double rival_ms = 0, rival_bytes = 0, rival_pairs = 0;
            for (const Technique& technique : techniques) {
                if (technique.method == MapMethod::brute && counts.front() > most_brute) continue;
                const bool measured = technique.method == MapMethod::megaviews || count == counts.front() ||
                                      count <= (technique.method == MapMethod::brute ? most_brute : options_.measured);
                BenchRow row = measured ? measure_maps(technique, distribution, lights, count) : extrapolated(largest.at(technique.name), count);
                if (measured && !reference.empty()) row.error["relMSE"] = white_error(reference, irradiance(lights, &technique, count), width, height);
                if (measured) largest[technique.name] = row;
                Plot::Line& line = lines[technique.name];
                line.points.push_back({double(count), row.ms.median()});
                if (measured) line.solid = line.points.size();
                if (technique.method == MapMethod::manylods)
                    rival_ms = row.ms.median(), rival_bytes = row.counters["at_once_bytes"], rival_pairs = row.counters["at_once_pairs_bytes"];
                if (technique.method == MapMethod::megaviews) {
                    row.counters["times_manylods_ms"] = rival_ms / row.ms.median();
                    row.counters["times_manylods_bytes"] = rival_bytes / row.counters["at_once_bytes"];
                    row.counters["times_manylods_pairs_bytes"] = rival_pairs / row.counters["at_once_pairs_bytes"];
                    if (count == counts.back()) fit(row, line.points);
                }
                table_rows_.push_back(row);
                sink_(row);
            }
        }
        for (const Technique& technique : techniques) {
            if (!lines.contains(technique.name)) continue;
            Plot::Line& line = lines[technique.name];
            line.name = std::string(technique.name) + " " + distribution.name, line.colour = technique.colours[d];
            lines_.push_back(std::move(line));
        }
    }

    Plot plot() const {
        return {"Maps of views of " + setting_.name(), "views", "maps, ms", lines_, true};
    }

    std::string csv() const {
        const char* stages[] = {"view tree", "pairs", "cut", "splat", "fuse", "brute"};
        const char* counters[] = {"node_views", "cut", "pairs", "pairs_culled", "pairs_edge_on", "pairs_rendered", "views_per_rendered_pair", "shared_maps", "at_once_pairs_bytes", "at_once_bytes"};
        std::string text = "distribution,technique,views,extrapolated,ms";
        for (const char* stage : stages) text += std::string(",") + stage + " ms";
        for (const char* counter : counters) text += std::string(",") + counter;
        text += "\n";
        char number[64];
        const auto add = [&](double value) { text.append(number, size_t(std::snprintf(number, sizeof number, ",%.8g", value))); };
        for (const BenchRow& row : table_rows_) {
            text += row.settings["distribution"].get<std::string>() + "," + row.technique + "," + std::to_string(row.views) + (row.extrapolated ? ",1" : ",0");
            add(row.ms.median());
            for (const char* stage : stages) row.stages.contains(stage) ? add(row.stages.at(stage).median()) : void(text += ",");
            for (const char* counter : counters) row.counters.contains(counter) ? add(row.counters.at(counter)) : void(text += ",");
            text += "\n";
        }
        return text;
    }

private:
    Lights make_lights(const Distribution& distribution, uint32_t count) {
        Lights lights;
        if (distribution.bounces > 0) {
            engine::Recorder recorder(device_);
            lights.vpls.emplace(device_, count, bvh_.constants());
            lights.vpls->prepare(recorder, geometry_, bvh_, table_, distribution.bounces, options_.seed);
            lights.vpls->record(recorder, geometry_, bvh_, table_, distribution.bounces, options_.seed);
            recorder.submit_and_wait();
            lights.alive = engine::download(device_, lights.vpls->count())[0];
            return lights;
        }
        std::mt19937 random(options_.seed);
        const auto uniform = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
        std::vector<Vpl> vpls;
        std::vector<View> views;
        const vec3 flux(float(table_.power() / count));
        for (uint32_t i = 0; i < count; ++i) {
            const float x = uniform(), y = uniform(), z = uniform(), up = 2 * uniform() - 1, around = 6.2831853f * uniform();
            const vec3 place = vec3(setting_.triangles.lo) + vec3(x, y, z) * vec3(setting_.triangles.hi - setting_.triangles.lo);
            const float across = std::sqrt(std::max(0.0f, 1 - up * up));
            const uint normal = pack_direction(vec3(across * std::cos(around), up, across * std::sin(around)));
            vpls.push_back({place, normal, flux, 1});
            views.push_back({place, 0, unpack_direction(normal), 1});
        }
        lights.random_vpls = engine::upload(device_, "vpls", "random lights", vpls);
        lights.random_views = engine::upload(device_, "vpls", "random views", views);
        lights.random_count = engine::upload(device_, "vpls", "random count", std::vector<uint>{count});
        lights.alive = count;
        return lights;
    }

    passes::MapSettings settings(MapMethod method) const {
        return {.map_size = options_.map_size, .epsilon = options_.epsilon, .method = method, .arity = options_.arity, .octree = draws_octree(method)};
    }
    bool draws_octree(MapMethod method) const { return octree_ && method == MapMethod::megaviews; }
    passes::MapScene map_scene() const { return {.tree = &tree_, .octree = octree_ ? &*octree_ : nullptr, .low = setting_.triangles.lo, .high = setting_.triangles.hi, .geometry = &geometry_}; }

    // Until no list is too short, and then so often as is measured.
    BenchRow measure_maps(const Technique& technique, const Distribution& distribution, const Lights& lights, uint32_t count) {
        BenchRow row;
        row.bench = "megaviews-views";
        row.scene = setting_.name();
        row.technique = technique.name;
        row.views = count;
        row.settings = {{"distribution", distribution.name}, {"map_size", options_.map_size}};
        if (distribution.bounces > 0) row.settings["bounces"] = distribution.bounces;
        if (technique.method != MapMethod::brute) row.settings["epsilon"] = options_.epsilon;
        if (draws_octree(technique.method)) row.settings["levels"] = octree_->depth();
        else if (technique.method != MapMethod::brute) row.settings["samples"] = tree_.leaves(), row.settings["arity"] = tree_.arity();
        device_.reset_memory_peaks();
        passes::ViewMaps maps(device_, settings(technique.method), count, 1, &derived_.world());
        engine::Recorder recorder(device_);
        passes::MapCounters counters;
        bool warm = false;
        while (row.ms.ms.size() < options_.repeats) {
            std::map<std::string, double> stages;
            maps.begin(recorder, map_scene(), lights.views(), lights.count());
            for (uint32_t first = 0; first < count;) {
                const uint32_t batch = maps.batch();
                maps.record(recorder, map_scene(), lights.views(), lights.count(), first);
                recorder.submit_and_wait();
                for (const engine::PassTime& t : recorder.take_times()) stages[t.name] += t.gpu_ms;
                if (maps.accept()) first += batch;
            }
            counters = maps.take_counters();
            if (std::exchange(warm, true) && counters.redone == 0) add_sample(row, stages);
        }
        count_maps(row, counters, lights.alive);
        set_bytes(row, device_);
        return row;
    }

    static void add_sample(BenchRow& row, const std::map<std::string, double>& stages) {
        double total = 0;
        for (const auto& [name, ms] : stages) row.stages[name].ms.push_back(ms), total += ms;
        row.ms.ms.push_back(total);
    }

    // `at_once`: what it takes to have the maps of all views, and the pairs or node-views that are drawn, at the same time, which batches avoid.
    void count_maps(BenchRow& row, const passes::MapCounters& counters, uint32_t alive) {
        auto& c = row.counters;
        c["vpls"] = alive, c["batches"] = counters.batches;
        const double map_bytes = double(map_texels(options_.map_size)) * sizeof(uint), pairs_bytes = double(counters.groups) * sizeof(uvec2);
        double atlas = row.views * map_bytes;
        if (row.technique == "brute") {
            c["triangle_views"] = double(setting_.data.world.count()) * alive;
        } else {
            c["groups"] = double(counters.groups), c["list_peak"] = double(counters.list_peak), c["list_capacity"] = double(counters.list_capacity);
        }
        if (row.technique == "manylods") c["node_views"] = double(counters.node_views), c["cut"] = double(counters.cut);
        if (row.technique == "megaviews") {
            c["pairs"] = double(counters.pairs), c["pairs_culled"] = double(counters.pairs_culled), c["pairs_edge_on"] = double(counters.pairs_edge_on), c["pairs_rendered"] = double(counters.pairs_rendered);
            c["views_per_rendered_pair"] = counters.pairs_rendered ? double(counters.views_of_rendered) / double(counters.pairs_rendered) : 0;
            c["shared_maps"] = double(counters.shared_maps);
            atlas += double(counters.shared_maps) * map_bytes + double(device_.memory().at("view tree").peak);
        }
        c["at_once_pairs_bytes"] = pairs_bytes, c["at_once_bytes"] = pairs_bytes + atlas;
    }

    static BenchRow extrapolated(const BenchRow& from, uint32_t count) {
        BenchRow row = from;
        const double times = double(count) / double(from.views);
        row.views = count, row.extrapolated = true;
        row.error.clear(), row.bytes.clear();
        row.ms.ms = {times * from.ms.median()};
        for (auto& [name, samples] : row.stages) samples.ms = {times * from.stages.at(name).median()};
        for (const char* limit : {"batches", "list_peak", "list_capacity"}) row.counters.erase(limit);
        for (auto& [name, value] : row.counters) value *= times;
        row.bytes["pairs"] = uint64_t(row.counters["at_once_pairs_bytes"]);
        row.bytes["atlas"] = uint64_t(row.counters["at_once_bytes"] - row.counters["at_once_pairs_bytes"]);
        return row;
    }

    // What each pixel gathers of all the lights, by these maps or by rays.
    std::vector<vec4> irradiance(const Lights& lights, const Technique* technique, uint32_t count) {
        const passes::GatheringSettings gathering{.visibility = technique ? passes::GatherVisibility::maps : passes::GatherVisibility::rays, .width = width,
                                                  .height = height, .lights = count, .filter = false,
                                                  .maps = technique ? settings(technique->method) : passes::MapSettings()};
        passes::Gathering pass(device_, gathering, bvh_.constants(), &derived_.world(), nullptr);
        const vec3 far = max(abs(vec3(setting_.triangles.lo)), abs(vec3(setting_.triangles.hi)));
        const passes::GatheringInputs in{.gbuffer = gbuffer_.gbuffer(), .lights = lights.lights(), .views = lights.views(), .count = lights.count(),
                                         .bound = float(std::min(3.14159265 * count / tree_.area(), 1e30)), .scene = map_scene(), .bvh = bvh_,
                                         .reach = std::max({far.x, far.y, far.z})};
        engine::Array<uint> exhausted(device_, "bench", "exhausted walks", 1);
        engine::Recorder recorder(device_);
        recorder.fill(exhausted, 0);
        pass.place(recorder, map_scene());
        pass.record(recorder, in, 0, exhausted, [](double) {});
        recorder.submit_and_wait();
        if (engine::download(device_, exhausted)[0]) throw DeviceError("a ray's walk needs more loop iterations than this driver allows; use Mesa 23 or later");
        return engine::download(device_, pass.irradiance(), uint64_t(width) * height);
    }

    // The exponent from 64k views on; where there are no two such numbers, over the last factor of 16.
    static void fit(BenchRow& row, std::vector<Plot::Point> points) {
        const auto since = [&](double from) { return std::count_if(points.begin(), points.end(), [&](auto& p) { return p.x >= from; }); };
        const double from = since(fit_from) >= 2 ? fit_from : points.back().x / 16;
        if (since(from) < 2) return;
        std::erase_if(points, [&](auto& p) { return p.x < from; });
        row.counters["exponent"] = exponent(points);
        row.counters["exponent_from"] = points.front().x;
        std::printf("%s: from %.0f views to %.0f, time goes with their %.2f-th power\n", row.settings["distribution"].get<std::string>().c_str(), points.front().x,
                    points.back().x, row.counters["exponent"]);
    }

    engine::Device& device_;
    const BenchOptions& options_;
    const Setting& setting_;
    const RowSink& sink_;
    passes::Geometry geometry_;
    passes::LightTable table_;
    compute::Derived derived_;
    compute::Bvh bvh_;
    compute::Bsh tree_;
    std::optional<compute::Svo> octree_;  // that MegaViews draws in its place
    passes::GBufferPass gbuffer_;
    std::vector<BenchRow> table_rows_;
    std::vector<Plot::Line> lines_;
};

std::vector<const Distribution*> chosen(const BenchOptions& options) {
    std::vector<const Distribution*> some;
    for (const Distribution& d : distributions)
        if (options.distributions.empty() || std::ranges::find(options.distributions, d.name) != options.distributions.end()) some.push_back(&d);
    return some;
}

}  // namespace

void bench_megaviews(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    for (const std::string& file : {options.csv, options.plot})
        if (!file.empty()) require_writable(file);
    std::vector<uint32_t> counts = options.views.empty() ? std::vector<uint32_t>{1024, 4096, 16384, 65536} : options.views;
    std::ranges::sort(counts);
    if (options.levels.size() > 1) throw InputError("--levels: megaviews-views draws one octree; give one number of levels");
    const Setting setting(options);
    std::printf("scene: %s, %zu triangles, 2^%u samples, maps 2 x %u^2, epsilon %g\n", setting.source.c_str(), size_t(setting.data.world.count()),
                options.log2_samples, options.map_size, options.epsilon);
    Experiment experiment(device, options, setting, sink);
    for (const Distribution* distribution : chosen(options)) experiment.run(*distribution, counts);
    if (!options.csv.empty()) write_text(options.csv, experiment.csv());
    if (!options.plot.empty()) write_text(options.plot, to_svg(experiment.plot()));
}

}  // namespace myriad::tools
