// `myriad bench octree`: the octree over points on the scene's surface, built on the device (compute/octree) and native on the host. The host's tree is
// compared with the device's before anything is timed. Stages: `keys` from points, `sort`, `nodes` of all levels, and `merge`, the plainest one: how many items
// are below each node. `ms` is the first three. The row `octree-triangles` builds the tree of all cells that triangles meet (compute/voxels), which must be those that
// a recursion on the host finds; its stage `voxels` is that search. `ms` is all four. The row `scene-octree` is all that a scene's octree takes to build (compute/svo), with
// what nodes hold; its stages are the passes of a frame that builds it. --levels asks for such rows alone.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>

#include "compute/common/radix_sort.hpp"
#include "compute/kernels.hpp"
#include "compute/octree/octree.hpp"
#include "compute/surface_sampling/surface_sampling.hpp"
#include "compute/svo/svo.hpp"
#include "compute/voxels/voxels.hpp"
#include "engine/transfer.hpp"
#include "passes/geometry/geometry.hpp"
#include "scenes/sky.hpp"
#include "tools/bench/maps_bench.hpp"

namespace myriad::tools {
namespace {

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

struct Item {
    uint64_t key;
    uint index;
};

struct NativeOctree {
    std::vector<uint> level_first, first;
    std::vector<uint64_t> keys;
    std::vector<Item> items;
};

struct Experiment {
    engine::Device& device;
    const BenchOptions& options;
    const RowSink& sink;
    const std::vector<vec4>& points;
    OctreeCube cube;

    BenchRow row(const char* technique) const {
        BenchRow r;
        r.bench = "octree";
        r.scene = std::filesystem::path(options.scene.empty() ? "builtin:atrium" : options.scene).filename().string();
        r.technique = technique;
        r.settings = {{"samples", points.size()}, {"levels", options.depth}};
        r.bytes = {{"pairs", 0}, {"atlas", 0}};
        return r;
    }

    // Sorted with all cores, then one pass over the keys with one; levels are put behind each other at the end.
    NativeOctree native() const {
        BenchRow r = row("native-octree");
        NativeOctree tree;
        const uint depth = options.depth;
        for (uint32_t run = 0; run <= options.repeats; ++run) {
            const auto start = std::chrono::steady_clock::now();
            std::vector<Item> items(points.size());
            engine::parallel_pieces(items.size(), 1 << 14, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end; ++i) {
                    const uvec2 key = octree_key(octree_cell(points[i], cube, depth));
                    items[i] = {uint64_t(key.y) << 32 | key.x, uint(i)};
                }
            });
            const double keys_ms = ms_since(start);
            compute::radix_sort(items, [](const Item& i) { return i.key; }, 0, int(3 * depth));
            const double sorted_ms = ms_since(start);
            std::vector<std::vector<uint64_t>> keys(depth + 1);
            std::vector<std::vector<uint>> first(depth + 1);  // within the level below
            for (size_t i = 0; i < items.size(); ++i) {
                const uint64_t key = items[i].key, changed = i ? key ^ items[i - 1].key : ~uint64_t(0);
                for (uint level = depth + 1; level-- > 0 && changed >> 3 * (depth - level);) {
                    first[level].push_back(level == depth ? uint(i) : uint(keys[level + 1].size()) - 1);
                    keys[level].push_back(key >> 3 * (depth - level));
                }
            }
            tree = {};
            uint below = 0;
            for (uint level = 0; level <= depth; ++level) {
                tree.level_first.push_back(below);
                below += uint(keys[level].size());
                for (const uint child : first[level]) tree.first.push_back(below + child);
                tree.keys.insert(tree.keys.end(), keys[level].begin(), keys[level].end());
            }
            tree.first.push_back(below + uint(items.size()));
            const double whole_ms = ms_since(start);
            tree.items = std::move(items);
            if (run == 0) continue;
            r.ms.ms.push_back(whole_ms);
            r.stages["keys"].ms.push_back(keys_ms);
            r.stages["sort"].ms.push_back(sorted_ms - keys_ms);
            r.stages["nodes"].ms.push_back(whole_ms - sorted_ms);
        }
        r.counters = {{"nodes", double(tree.keys.size())}, {"Mitems/s", double(points.size()) / r.ms.median() / 1000}};
        sink(r);
        return tree;
    }

    void on_device(const NativeOctree& expected) const {
        BenchRow r = row("octree");
        const auto on = engine::upload(device, "bench", "bench points", points);
        const auto count = engine::upload(device, "bench", "bench count", std::vector<uint>{uint(points.size())});
        const engine::Program tally_program(device, engine::compute_kernels, "octree/tally");
        device.reset_memory_peaks();
        uint64_t capacity = 2 * points.size();
        auto octree = std::make_unique<compute::Octree>(device, points.size(), capacity, options.depth);
        engine::Array<uint> tally(device, "bench", "tally", capacity);
        engine::Recorder recorder(device);
        for (uint32_t run = 0; run <= options.repeats;) {
            {
                auto scope = recorder.scope("octree keys");
                octree->record_keys(recorder, on, count, 0, cube);
            }
            octree->record(recorder, count);
            {
                auto scope = recorder.scope("octree merge");
                octree->bottom_up(recorder, tally_program, [&](uint level) {
                    const OctreeRef ref = octree->read(recorder);
                    return OctreeTallyPush{.first = ref.first, .tally = recorder.write(tally), .state = ref.state, .level = level, .leaves = level == options.depth};
                });
            }
            octree->end(recorder);
            recorder.submit_and_wait();
            const auto times = recorder.take_times();
            if (!octree->report().ok()) {  // longer, and again
                capacity = octree->report().needed();
                octree.reset();
                octree = std::make_unique<compute::Octree>(device, points.size(), capacity, options.depth);
                tally = {device, "bench", "tally", capacity};
                continue;
            }
            if (run == 0) verify(*octree, engine::download(device, tally, 1)[0], expected);
            if (run++ == 0) continue;
            double total = 0;
            for (const engine::PassTime& t : times) {
                const std::string stage = t.name.substr(std::string("octree ").size());
                r.stages[stage].ms.push_back(t.gpu_ms);
                if (stage != "merge") total += t.gpu_ms;
            }
            r.ms.ms.push_back(total);
        }
        const OctreeState state = octree->report().state;
        const uint leaves = state.count[options.depth];
        r.counters = {{"nodes", double(state.needed)}, {"leaves", leaves}, {"items_per_leaf", double(points.size()) / leaves},
                      {"Mitems/s", double(points.size()) / r.ms.median() / 1000}};
        for (uint level = 0; level <= options.depth; ++level) r.counters["nodes_" + std::to_string(level / 10) + std::to_string(level % 10)] = state.count[level];
        set_bytes(r, device);
        r.bytes["tree"] = uint64_t(state.needed) * (sizeof(uint) + sizeof(uvec2));
        sink(r);
    }

    void verify(const compute::Octree& octree, uint tally, const NativeOctree& expected) const {
        const OctreeState state = octree.report().state;
        bool equal = state.needed == expected.keys.size() && tally == points.size() && engine::download(device, octree.first(), expected.first.size()) == expected.first;
        for (uint level = 0; level <= options.depth; ++level) equal = equal && state.first[level] == expected.level_first[level];
        const auto keys = engine::download(device, octree.keys(), expected.keys.size());
        for (size_t i = 0; equal && i < keys.size(); ++i) equal = (uint64_t(keys[i].y) << 32 | keys[i].x) == expected.keys[i];
        const auto items = engine::download(device, octree.sorted_items(), points.size());
        for (size_t i = 0; equal && i < items.size(); ++i) equal = items[i] == expected.items[i].index;
        if (!equal) throw Error(Error::Kind::check_failed, "the device's octree differs from the native one");
    }
};

// The same for the same set of pairs, whatever the order: a sum of hashes (splitmix64).
uint64_t pair_hash(uvec2 pair) {
    uint64_t x = uint64_t(pair.y) << 32 | pair.x;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

// Cells that a scene's triangles meet.
struct TriangleExperiment {
    engine::Device& device;
    const BenchOptions& options;
    const RowSink& sink;
    const compute::WorldTriangles& world;
    const passes::Geometry& geometry;
    OctreeCube cube;

    struct Pairs {
        std::atomic<uint64_t> count = 0, hash = 0;
    };
    void descend(const VoxelTriangle& t, uvec2 key, uint level, uint triangle, uint64_t& count, uint64_t& hash) const {
        for (uint found = voxel_children(t, key, level, options.depth); found; found &= found - 1) {
            const uvec2 child = voxel_child_key(key, uint(__builtin_ctz(found)));
            if (level + 1 < options.depth) descend(t, child, level + 1, triangle, count, hash);
            else ++count, hash += pair_hash(voxel_pack(child, triangle));
        }
    }
    void on_host(Pairs& pairs) const {
        engine::parallel_pieces(world.count(), 1 << 10, [&](size_t begin, size_t end) {
            uint64_t count = 0, hash = 0;
            world.for_each(uint32_t(begin), uint32_t(end),
                           [&](uint32_t id, uint32_t, const Corners& c) { descend(voxel_triangle(c, cube, options.depth), uvec2(0), 0, id, count, hash); });
            pairs.count += count, pairs.hash += hash;
        });
    }

    void run() const {
        BenchRow r;
        r.bench = "octree";
        r.scene = std::filesystem::path(options.scene.empty() ? "builtin:atrium" : options.scene).filename().string();
        r.technique = "octree-triangles";
        r.settings = {{"triangles", world.count()}, {"levels", options.depth}};
        Pairs expected;
        on_host(expected);
        const auto count = engine::upload(device, "bench", "bench count", std::vector<uint>{world.count()});
        const compute::VoxelTriangles triangles{geometry.positions(), geometry.triangles(), geometry.instances(), uint32_t(world.instances.size())};
        device.reset_memory_peaks();
        uint64_t next = 2 * uint64_t(world.count()), kept = next, nodes = next;
        std::unique_ptr<compute::Voxels> voxels;
        std::unique_ptr<compute::Octree> octree;
        engine::Recorder recorder(device);
        for (uint32_t run = 0; run <= options.repeats;) {
            if (!voxels) {
                if (std::max({next, kept, nodes}) > compute::AppendLists::max_capacity)
                    throw InputError("so many cells are met that lists cannot hold them; give a smaller --depth");
                octree.reset();
                voxels = std::make_unique<compute::Voxels>(device, compute::AppendMode::scan, options.depth, next, kept, world.constants());
                octree = std::make_unique<compute::Octree>(device, kept, nodes, options.depth);
            }
            {
                auto scope = recorder.scope("octree voxels");
                voxels->record(recorder, triangles, count, 0, world.count(), cube);
            }
            {
                auto scope = recorder.scope("octree keys");
                voxels->record_items(recorder, *octree);
            }
            octree->record(recorder, voxels->lists().state(), compute::AppendLists::kept_word);
            octree->end(recorder);
            recorder.submit_and_wait();
            const auto times = recorder.take_times();
            const compute::AppendReport report = voxels->lists().report();
            if (!report.ok() || !octree->report().ok()) {  // longer, and again
                next = std::max(next, report.next_needed), kept = std::max(kept, report.kept_needed), nodes = std::max(nodes, octree->report().needed());
                voxels.reset();
                continue;
            }
            if (run == 0) {
                uint64_t hash = 0;
                for (const uvec2 pair : engine::download(device, voxels->lists().kept(), report.kept)) hash += pair_hash(pair);
                if (report.kept != expected.count || hash != expected.hash)
                    throw Error(Error::Kind::check_failed, "the cells that triangles meet differ from those that the host finds");
            }
            if (run++ == 0) continue;
            double total = 0;
            for (const engine::PassTime& t : times) {
                r.stages[t.name.substr(std::string("octree ").size())].ms.push_back(t.gpu_ms);
                total += t.gpu_ms;
            }
            r.ms.ms.push_back(total);
        }
        const compute::AppendReport report = voxels->lists().report();
        const OctreeState state = octree->report().state;
        const uint leaves = state.count[options.depth];
        r.counters = {{"pairs", double(report.kept)}, {"pairs_processed", double(report.processed)}, {"nodes", double(state.needed)}, {"leaves", leaves},
                      {"Mpairs_processed/s", double(report.processed) / r.stages["voxels"].median() / 1000}};
        set_bytes(r, device);
        r.bytes["tree"] = uint64_t(state.needed) * (sizeof(uint) + sizeof(uvec2));
        sink(r);
    }
};

// All of compute/svo. The first build finds out how long lists must be, as a first frame's does, and is not counted.
void bench_scene_octree(engine::Device& device, const BenchOptions& options, const RowSink& sink, const compute::WorldTriangles& world, const passes::Geometry& geometry,
                        uint32_t depth, const vec3& low, const vec3& high) {
    BenchRow r;
    r.bench = "octree";
    r.scene = std::filesystem::path(options.scene.empty() ? "builtin:atrium" : options.scene).filename().string();
    r.technique = "scene-octree";
    r.settings = {{"triangles", world.count()}, {"levels", depth}};
    device.reset_memory_peaks();
    compute::Svo svo(device, world, depth, low, high);
    engine::Recorder recorder(device);
    for (uint32_t run = 0; run <= options.repeats; ++run) {
        svo.build(recorder, geometry.positions(), geometry.triangles(), geometry.instances(), geometry.opacity());
        const auto times = recorder.take_times();
        if (run == 0) {
            r.counters["first_tries"] = svo.size().tries;
            continue;
        }
        double total = 0;
        for (const engine::PassTime& t : times) {
            const std::string prefix = "octree ";
            r.stages[t.name.starts_with(prefix) ? t.name.substr(prefix.size()) : t.name].ms.push_back(t.gpu_ms);
            total += t.gpu_ms;
        }
        r.ms.ms.push_back(total);
    }
    const compute::SvoSize& size = svo.size();
    r.counters["pairs"] = double(size.pairs), r.counters["nodes"] = double(size.nodes), r.counters["leaves"] = double(size.leaves);
    set_bytes(r, device);
    r.bytes["tree"] = size.bytes();
    r.bytes["a_leaf"] = compute::SvoSize{.nodes = 1, .leaves = 1}.bytes() - sizeof(SvoBlock);
    r.bytes["an_inner_node"] = r.bytes["a_leaf"] + sizeof(SvoBlock);
    sink(r);
}

}  // namespace

void bench_octree(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const std::string source = options.scene.empty() ? "builtin:atrium" : options.scene;
    scenes::Scene scene = scenes::load(source, options.seed);
    const scenes::Triangles triangles = scenes::flatten(scene);
    const passes::GeometryData data = passes::geometry_data(scene, triangles);
    const compute::SurfaceSampling sampling = compute::sample_surface(data.world, options.levels.empty() ? options.log2_samples : 0, options.seed);
    if (sampling.empty()) throw InputError("\"" + source + "\" has no surface to sample; give another --scene");
    if (options.levels.empty()) {
        std::vector<vec4> points;
        for (const SurfaceSample& s : sampling.samples) {
            const Corners c = data.world.corners(s.triangle);
            points.emplace_back((1 - s.u - s.v) * c.p0 + s.u * c.p1 + s.v * c.p2, 0);
        }
        const OctreeCube cube = compute::octree_cube(triangles.lo, triangles.hi, options.depth);
        std::printf("scene: %s, %zu points, %u levels below the root\n", source.c_str(), points.size(), options.depth);
        const Experiment e{device, options, sink, points, cube};
        e.on_device(e.native());
        if (options.depth < 1 || options.depth > voxels_max_depth) {
            std::printf("no tree of triangles: that takes 1 to %u levels\n", voxels_max_depth);
            return;
        }
    }
    const passes::Geometry geometry(device, triangles, data);
    if (options.levels.empty()) TriangleExperiment{device, options, sink, data.world, geometry, compute::octree_cube(triangles.lo, triangles.hi, options.depth)}.run();
    for (const uint32_t depth : options.levels.empty() ? std::vector{options.depth} : options.levels)
        bench_scene_octree(device, options, sink, data.world, geometry, depth, triangles.lo, triangles.hi);
}

}  // namespace myriad::tools
