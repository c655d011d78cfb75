// `myriad bench manylods-table2`: Table 2 of ManyLoDs, and its single-view rendering (Figure 6). For 2^samples points and twice as many, at
// 1024 x 1024 pixels: how long it takes to build the tree from the triangles (`build`), to update it when they have moved (`update`), to copy as many
// bytes as it has (`copy`), to see the scene by rays (`poly`), and by points, from cuts at c = 1, 2 and 4 pixels (`points`). All cuts are compared with
// a recursion on the host before anything is timed. `error` is against the rays.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "compute/bsh/bsh.hpp"
#include "compute/bsh/copy_io.h"
#include "compute/kernels.hpp"
#include "compute/manylods/manylods_io.h"
#include "engine/transfer.hpp"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/points/points.hpp"
#include "scenes/sky.hpp"
#include "tools/bench/maps_bench.hpp"

namespace myriad::tools {
namespace {

constexpr uint32_t side = 1024;

std::vector<std::string> default_scenes() {
    std::vector<std::string> scenes = {"builtin:teatime"};
    const char *corpus = std::getenv("MYRIAD_CORPUS"), *home = std::getenv("HOME");
    const std::filesystem::path folder = corpus ? corpus : std::filesystem::path(home ? home : ".") / ".cache/myriad/corpus";
    if (std::filesystem::exists(folder / "dragon.glb")) scenes.push_back(folder / "dragon.glb");
    return scenes;
}

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Milliseconds of each stage of what was recorded last.
std::map<std::string, double> take_stages(engine::Recorder& recorder) {
    std::map<std::string, double> stages;
    for (const engine::PassTime& t : recorder.take_times()) stages[t.name] += t.gpu_ms;
    return stages;
}

struct Experiment {
    engine::Device& device;
    const BenchOptions& options;
    const RowSink& sink;
    std::string scene;
    const compute::WorldTriangles& world;
    const passes::Geometry& geometry;
    const compute::Bvh& bvh;
    scenes::Camera camera;
    uint32_t log2_samples;

    BenchRow row(const char* technique) const {
        BenchRow r;
        r.bench = "manylods-table2";
        r.scene = std::filesystem::path(scene).filename().string();
        r.technique = technique;
        r.views = 1;
        r.settings = {{"samples", uint64_t(1) << log2_samples}};
        return r;
    }
    void finish(BenchRow& r) const {
        set_bytes(r, device);
        sink(r);
    }

    void refit(engine::Recorder& recorder, compute::Bsh& tree) const {
        auto scope = recorder.scope("refit");
        tree.refit(recorder, geometry.positions(), geometry.triangles(), geometry.instances(), geometry.opacity());
    }

    // From triangles to a tree with bounds.
    std::unique_ptr<compute::Bsh> build(engine::Recorder& recorder) const {
        BenchRow r = row("build");
        device.reset_memory_peaks();
        std::unique_ptr<compute::Bsh> tree;
        for (uint32_t run = 0; run <= options.repeats; ++run) {  // run 0 warms up
            tree.reset();
            const auto start = std::chrono::steady_clock::now();
            const compute::BshLeaves leaves = compute::bsh_leaves(world, log2_samples, options.seed);
            const double order = ms_since(start);
            tree = std::make_unique<compute::Bsh>(device, world, leaves);
            refit(recorder, *tree);
            recorder.submit_and_wait();
            const double whole = ms_since(start);
            if (run == 0) continue;
            r.ms.ms.push_back(whole);
            r.stages["samples and order"].ms.push_back(order);
            r.stages["upload and bounds"].ms.push_back(whole - order);
        }
        recorder.take_times();
        r.counters = {{"blocks", double(tree->blocks())}};
        finish(r);
        return tree;
    }

    // Turn by turn, so that both see the same machine.
    void update(engine::Recorder& recorder, compute::Bsh& tree) const {
        BenchRow r = row("update"), c = row("copy");
        device.reset_memory_peaks();
        const auto expected = engine::download(device, tree.spheres());
        const uint64_t words = tree.bytes() / 16;
        const engine::Program program(device, engine::compute_kernels, "bsh/copy");
        std::vector<uvec4> pattern(words);
        for (uint64_t i = 0; i < words; ++i) pattern[i] = uvec4(uint(i), uint(i * 7), ~uint(i), 5);
        const auto from = engine::upload(device, "bench", "copied from", pattern);
        const engine::Array<uvec4> to(device, "bench", "copied to", words);
        for (uint32_t run = 0; run <= options.repeats; ++run) {
            refit(recorder, tree);
            recorder.submit_and_wait();
            const double refitted = take_stages(recorder)["refit"];
            {
                auto scope = recorder.scope("copy");
                recorder.dispatch(program, BshCopyPush{recorder.read(from), recorder.write(to), uint(words)}, words);
            }
            recorder.submit_and_wait();
            const double copied = take_stages(recorder)["copy"];
            if (run == 0) continue;
            r.ms.ms.push_back(refitted), c.ms.ms.push_back(copied);
        }
        if (engine::download(device, to) != pattern) throw Error(Error::Kind::check_failed, "the copy differs from what was copied");
        if (engine::download(device, tree.spheres()) != expected) throw Error(Error::Kind::check_failed, "an update in place changed the tree");
        r.counters = {{"tree_bytes", double(tree.bytes())}, {"times_copy", r.ms.median() / c.ms.median()}};
        c.counters = {{"GB/s", 2 * double(words) * 16 / c.ms.median() / 1e6}};
        finish(r), finish(c);
    }

    std::vector<vec4> poly(engine::Recorder& recorder) const {
        BenchRow r = row("poly");
        r.settings["width"] = side, r.settings["height"] = side;
        r.settings.erase("samples");
        device.reset_memory_peaks();
        passes::GBufferPass pass(device, side, side, bvh.constants());
        for (uint32_t run = 0; run <= options.repeats; ++run) {
            {
                auto scope = recorder.scope("all");
                pass.record(recorder, geometry, bvh, camera);
            }
            {
                auto scope = recorder.scope("shade");
                pass.record_seen(recorder, geometry, camera);
            }
            recorder.submit_and_wait();
            auto stages = take_stages(recorder);
            if (run == 0) continue;
            r.ms.ms.push_back(stages["all"]);
            r.stages["trace"].ms.push_back(stages["all"] - stages["shade"]);
            r.stages["shade"].ms.push_back(stages["shade"]);
        }
        finish(r);
        return engine::download(device, pass.gbuffer().positions);
    }

    // The cut as it should be: (slot, culled), sorted.
    struct Cut {
        std::vector<std::pair<uint, bool>> nodes;
        uint64_t tested = 0;
    };
    Cut recursion(const compute::Bsh& tree, const View& view, float c) const {
        const auto frames = engine::download(device, tree.frames());
        const auto spheres = engine::download(device, tree.spheres());
        Cut cut;
        std::vector<uint> left{tree.root()};
        while (!left.empty()) {
            const uint slot = left.back();
            left.pop_back();
            if (bsh_is_absent(spheres[slot])) continue;
            ++cut.tested;
            const uint where = classify(view, bsh_decode(frames[slot / tree.arity()], spheres[slot]), bsh_height(slot, tree.shape()), c, pinhole_size(side, side));
            if (where != node_view_open) {
                cut.nodes.emplace_back(slot, where == node_view_culled);
                continue;
            }
            for (uint i = 0; i < tree.arity(); ++i) left.push_back(tree.arity() * bsh_block_of(slot, tree.shape()) + i);
        }
        std::sort(cut.nodes.begin(), cut.nodes.end());
        return cut;
    }
    void verify(const compute::Bsh& tree, const passes::PointsPass& pass, const passes::PointsCounters& counters, float c) const {
        const CameraPush push = passes::camera_push(camera, side, side);
        const View view = pinhole_view(push.position, push.right, push.up, push.forward, points_margin * tree.sample_radius());
        const Cut expected = recursion(tree, view, c);
        std::vector<std::pair<uint, bool>> found;
        for (const uvec2& code : engine::download(device, pass.lists().kept(), counters.groups)) {
            const CutGroup g = cut_unpack(code);
            for (uint i = 0; i < tree.arity(); ++i)
                if ((g.drawn | g.culled) >> i & 1) found.emplace_back(tree.arity() * g.block + i, g.culled >> i & 1);
        }
        std::sort(found.begin(), found.end());
        if (found != expected.nodes || counters.node_views != expected.tested)
            throw Error(Error::Kind::check_failed, "the camera's cut differs from the recursion's on the host");
    }

    void points(engine::Recorder& recorder, const compute::Bsh& tree, const std::vector<vec4>& exact, float c) const {
        BenchRow r = row("points");
        r.settings["width"] = side, r.settings["height"] = side, r.settings["c"] = c;
        device.reset_memory_peaks();
        passes::GBufferPass gbuffer(device, side, side, bvh.constants(), false, false);
        passes::PointsPass pass(device, {.pixels = c}, tree, geometry, world, side, side, bvh.constants());
        passes::PointsCounters counters;
        for (uint32_t run = 0; run <= options.repeats;) {
            pass.record(recorder, passes::camera_push(camera, side, side), gbuffer.hits());
            {
                auto scope = recorder.scope("shade");
                gbuffer.record_seen(recorder, geometry, camera);
            }
            recorder.submit_and_wait();
            const auto stages = take_stages(recorder);
            if (!pass.accept()) continue;
            counters = pass.take_counters();
            if (run == 0) verify(tree, pass, counters, c);
            if (run++ == 0) continue;
            double total = 0;
            for (const auto& [name, ms] : stages) {
                total += ms;
                r.stages[name.starts_with("points ") ? name.substr(7) : name].ms.push_back(ms);
            }
            r.ms.ms.push_back(total);
        }
        r.counters = {{"node_views", double(counters.node_views)}, {"cut", double(counters.cut)}, {"points", double(counters.drawn)}};
        // Shares of all pixels: nothing, where there is something; something, where there is nothing; a depth that is off by more than a hundredth.
        double holes = 0, strays = 0, deep = 0;
        const auto found = engine::download(device, gbuffer.gbuffer().positions);
        for (size_t i = 0; i < exact.size(); ++i) {
            holes += exact[i].w > 0 && found[i].w == 0, strays += exact[i].w == 0 && found[i].w > 0;
            deep += exact[i].w > 0 && found[i].w > 0 && std::abs(found[i].w - exact[i].w) > 0.01f * exact[i].w;
        }
        r.error = {{"holes", holes / double(exact.size())}, {"strays", strays / double(exact.size())}, {"another_depth", deep / double(exact.size())}};
        finish(r);
    }
};

}  // namespace

void bench_table2(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    for (const std::string& source : options.scene.empty() ? default_scenes() : std::vector<std::string>{options.scene}) {
        scenes::Scene scene = scenes::load(source, options.seed);
        scenes::apply_sky(scene, scenes::SkyChoice::automatic);
        const scenes::Triangles triangles = scenes::flatten(scene);
        const passes::GeometryData data = passes::geometry_data(scene, triangles);
        const passes::Geometry geometry(device, triangles, data);
        const compute::Bvh bvh(device, data.world, compute::BvhQuality::quick, geometry.opacity());
        std::printf("scene: %s, %zu triangles, %ux%u pixels\n", source.c_str(), size_t(triangles.count()), side, side);
        engine::Recorder recorder(device);
        std::vector<vec4> exact;
        for (const uint32_t log2_samples : {options.log2_samples, options.log2_samples + 1}) {
            const Experiment e{device, options, sink, source, data.world, geometry, bvh, scenes::pick_camera(scene, triangles, options.camera), log2_samples};
            if (exact.empty()) exact = e.poly(recorder);
            const auto tree = e.build(recorder);
            if (tree->empty()) throw InputError("\"" + source + "\" has no surface to sample; give another --scene");
            e.update(recorder, *tree);
            for (const float c : {1.0f, 2.0f, 4.0f}) e.points(recorder, *tree, exact, c);
        }
    }
}

}  // namespace myriad::tools
