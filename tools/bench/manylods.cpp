// `myriad bench manylods`: cut and splat of VPL views. Rows: the device's append lists in both modes, a depth-first walk a view on the
// device, and both algorithms native on the host with two threads or as many as there are. All cuts are compared before anything is
// timed; ms is cut + splat for the device's lists, the cut alone for the others.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "compute/bsh/bsh.hpp"
#include "compute/manylods/manylods.hpp"
#include "engine/transfer.hpp"
#include "passes/maps/maps.hpp"
#include "passes/vpl/vpl.hpp"
#include "scenes/sky.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/native_cut.hpp"

namespace myriad::tools {
namespace {

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// The same for the same set of node-views, whatever the order or the grouping: a sum of hashes (splitmix64).
struct CutHash {
    uint64_t sum = 0, node_views = 0;
    void add(const std::vector<uvec2>& groups) {
        for (const uvec2& code : groups) {
            const CutGroup g = cut_unpack(code);
            for (uint m = g.drawn | g.culled << 8; m; m &= m - 1) {
                uint64_t x = (uint64_t(g.block) << 32 | g.view) * 16 + uint64_t(__builtin_ctz(m));
                x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
                x = (x ^ x >> 27) * 0x94d049bb133111ebu;
                sum += x ^ x >> 31;
                ++node_views;
            }
        }
    }
    bool operator==(const CutHash&) const = default;
};

std::string default_scene() {
    for (const char* path : {"../shared/data/sponza.glb", "shared/data/sponza.glb"})
        if (std::filesystem::exists(path)) return path;
    return "builtin:atrium";
}

struct Experiment {
    engine::Device& device;
    const BenchOptions& options;
    const RowSink& sink;
    std::string scene;
    compute::Bsh tree;
    engine::Array<View> views;
    std::vector<View> host_views;
    NativeTree native;

    BenchRow row(const char* technique, uint32_t count) const {
        BenchRow r;
        r.bench = "manylods";
        r.scene = scene;
        r.technique = technique;
        r.views = count;
        r.settings = {{"epsilon", options.epsilon}, {"map_size", options.map_size}, {"samples", tree.leaves()}, {"arity", tree.arity()}};
        return r;
    }

    void device_lists(uint32_t count, compute::AppendMode mode, const CutHash& expected) {
        BenchRow r = row("lists", count);
        r.settings["append"] = mode == compute::AppendMode::scan ? "scan" : "atomic";
        const auto on_device = engine::upload(device, "vpls", "bench view count", std::vector<uint>{count});
        device.reset_memory_peaks();
        passes::ViewMaps maps(device, {.append = mode, .map_size = options.map_size, .epsilon = options.epsilon, .arity = tree.arity()}, count, 1);
        engine::Recorder recorder(device);
        passes::MapCounters counters;
        for (uint32_t run = 0; run <= options.repeats; ++run) {  // run 0 warms up, lets the lists grow, and is compared
            CutHash hash;
            for (uint32_t first = 0; first < count;) {
                const uint32_t batch = maps.batch();
                maps.record(recorder, {.tree = &tree}, views, on_device, first);
                recorder.submit_and_wait();
                if (!maps.accept()) continue;
                if (run == 0) hash.add(engine::download(device, maps.lists()->kept(), maps.lists()->report().kept));
                first += batch;
            }
            counters = maps.take_counters();
            double total = 0;
            std::map<std::string, double> stages;
            for (const engine::PassTime& t : recorder.take_times()) stages[t.name] += t.gpu_ms, total += t.gpu_ms;
            if (run == 0) {
                if (!(hash == expected)) throw Error(Error::Kind::check_failed, "the device's cut differs from the native one");
                continue;
            }
            r.ms.ms.push_back(total);
            for (auto& [name, ms] : stages) r.stages[name].ms.push_back(ms);
        }
        r.counters = {{"node_views", double(counters.node_views)}, {"cut", double(counters.cut)}, {"groups", double(counters.groups)},
                      {"list_capacity", double(counters.list_capacity)}, {"list_peak", double(counters.list_peak)}, {"batches", counters.batches},
                      {"Mnode_views/s", double(counters.node_views) / r.stages["cut"].median() / 1000}};
        fill_bytes(r);
        sink(r);
    }

    void device_walk(uint32_t count, const CutHash& expected, uint64_t groups, uint64_t node_views) {
        BenchRow r = row("depth-first", count);
        const auto on_device = engine::upload(device, "vpls", "bench view count", std::vector<uint>{count});
        device.reset_memory_peaks();
        engine::Array<uvec2> kept(device, "lists", "walk cut", groups);
        engine::Array<uint> state(device, "lists", "walk state", sizeof(AppendState) / sizeof(uint));
        compute::ManyLods manylods(device, compute::bsh_constants(tree.arity()));
        engine::Recorder recorder(device);
        for (uint32_t run = 0; run <= options.repeats; ++run) {
            {
                auto scope = recorder.scope("cut");
                manylods.record_walk(recorder, kept, state, {tree, views, on_device, 0, count, options.epsilon, options.map_size});
            }
            recorder.submit_and_wait();
            const double ms = recorder.take_times().front().gpu_ms;
            if (run > 0) {
                r.ms.ms.push_back(ms);
                r.stages["cut"].ms.push_back(ms);
                continue;
            }
            CutHash hash;
            hash.add(engine::download(device, kept, engine::download(device, state)[compute::AppendLists::kept_word]));
            if (!(hash == expected)) throw Error(Error::Kind::check_failed, "the walk's cut differs from the native one");
        }
        r.counters = {{"node_views", double(node_views)}, {"cut", double(expected.node_views)},
                      {"Mnode_views/s", double(node_views) / r.ms.median() / 1000}};
        fill_bytes(r);
        sink(r);
    }

    // `run` is one of NativeCuts' two. The first sets the hash that everything after it must equal.
    template <class Run>
    void native_row(const char* technique, uint32_t count, NativeCuts& cuts, CutHash& hash, Run run) {
        BenchRow r = row(technique, count);
        const std::vector<View> some(host_views.begin(), host_views.begin() + count);
        r.settings["threads"] = cuts.threads();
        for (uint32_t i = 0; i <= options.repeats; ++i) {  // run 0 warms up: memory is there afterwards
            const auto start = std::chrono::steady_clock::now();
            (cuts.*run)(native, some, options.epsilon, options.map_size);
            if (i > 0) r.ms.ms.push_back(ms_since(start));
        }
        r.stages["cut"] = r.ms;
        CutHash mine;
        uint64_t groups = 0;
        for (unsigned t = 0; t < cuts.threads(); ++t) mine.add(cuts.groups(t)), groups += cuts.groups(t).size();
        if (hash.node_views && !(hash == mine)) throw Error(Error::Kind::check_failed, "the native cuts differ");
        hash = mine;
        r.counters = {{"node_views", double(cuts.node_views())}, {"cut", double(mine.node_views)}, {"groups", double(groups)},
                      {"Mnode_views/s", double(cuts.node_views()) / r.ms.median() / 1000}};
        r.bytes = {{"pairs", cuts.bytes()}, {"atlas", 0}};
        sink(r);
    }

    void fill_bytes(BenchRow& r) const {
        for (const auto& [kind, use] : device.memory()) r.bytes[kind == "lists" ? "pairs" : kind] = use.peak;
        r.bytes.try_emplace("atlas", 0);
    }
};

}  // namespace

void bench_manylods(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const std::string source = options.scene.empty() ? default_scene() : options.scene;
    const std::vector<uint32_t> counts = options.views.empty() ? std::vector<uint32_t>{256, 1024, 4096} : options.views;
    const uint32_t most = *std::max_element(counts.begin(), counts.end());
    scenes::Scene scene = scenes::load(source, options.seed);
    scenes::apply_sky(scene, scenes::SkyChoice::automatic);
    const scenes::Triangles triangles = scenes::flatten(scene);
    if (!native_available()) throw DeviceError("this experiment's native rows need a processor with AVX2 and FMA");

    // Views: one-bounce VPLs of the scene's lights. Paths that leave the scene make none, so more are shot than are used.
    const passes::GeometryData data = passes::geometry_data(scene, triangles);
    const passes::Geometry geometry(device, triangles, data);
    const passes::LightTable lights(device, scene, triangles, data);
    const compute::WorldTriangles& world = data.world;
    const compute::Bvh bvh(device, world, compute::BvhQuality::quick, geometry.opacity());
    passes::VplPass vpls(device, most * 4, bvh.constants());
    compute::check_bsh_size(options.log2_samples, options.arity);
    compute::Bsh tree(device, world, options.log2_samples, options.seed, options.arity);
    engine::Recorder recorder(device);
    vpls.record(recorder, geometry, bvh, lights, 1, options.seed);
    tree.refit(recorder, geometry.positions(), geometry.triangles(), geometry.instances(), geometry.opacity());
    recorder.submit_and_wait();
    const uint alive = engine::download(device, vpls.count())[0];
    if (alive < most) throw InputError("\"" + source + "\" yields " + std::to_string(alive) + " VPLs, fewer than --views " + std::to_string(most));
    std::vector<View> views = engine::download(device, vpls.views(), alive);
    std::vector<View> spread(most);  // evenly over all paths
    for (uint32_t i = 0; i < most; ++i) spread[i] = views[size_t(i) * alive / most];
    std::printf("scene: %s, %zu triangles, 2^%u samples, %u blocks of %u, maps 2 x %u^2, epsilon %g\n", source.c_str(), size_t(triangles.count()),
                tree.depth(), tree.blocks(), tree.arity(), options.map_size, options.epsilon);

    NativeTree native{tree.shape(), engine::download(device, tree.frames()), engine::download(device, tree.spheres()),
                      engine::download(device, tree.cones())};
    Experiment experiment{device, options, sink, std::filesystem::path(source).filename().string(), std::move(tree),
                          engine::upload(device, "vpls", "bench views", spread), spread, std::move(native)};
    for (uint32_t count : counts) {
        CutHash hash;
        NativeCuts cuts(std::max(1u, std::thread::hardware_concurrency()));
        experiment.native_row("native-lists", count, cuts, hash, &NativeCuts::lists);
        experiment.native_row("native-depth-first", count, cuts, hash, &NativeCuts::depth_first);
        uint64_t groups = 0;
        for (unsigned t = 0; t < cuts.threads(); ++t) groups += cuts.groups(t).size();
        experiment.device_lists(count, compute::AppendMode::scan, hash);
        experiment.device_lists(count, compute::AppendMode::atomic, hash);
        experiment.device_walk(count, hash, groups, cuts.node_views());
    }
}

}  // namespace myriad::tools
