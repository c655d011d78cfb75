#include "tools/stats.hpp"

#include "tools/render_image.hpp"
#include "tools/temp_folder.hpp"
#include "tools/trace.hpp"

#include <limits>

namespace myriad::tools {
namespace {

using nlohmann::json;

engine::PassTime pass(const char* name, double gpu, double cpu, double gpu_begin, double cpu_begin) {
    return {name, gpu, cpu, gpu_begin, cpu_begin};
}

RunRecord made_up() {
    RunRecord run;
    run.device.name = "Device \"X\"", run.device.driver = "driver", run.device.driver_version = "1.2";
    run.scene = "caf\xe9.glb", run.camera = "nave";  // Latin-1 in a name must not spoil the JSON
    run.size.triangles = 12, run.size.samples = 8, run.size.bsh_blocks = 1, run.size.bvh_nodes = 3, run.size.lights = 1;
    run.settings = settings_json({}, 0.1f);
    run.recorder_ms = 10;
    run.phases = {{"load", 0, 4}, {"build", 4, 6}};
    for (int f = 0; f < 3; ++f) {
        FrameRun frame;
        frame.host = {"frame " + std::to_string(f), 20.0 + 30 * f, 30};
        const double at = 30 * f;  // the GPU's clock began 11 ms after the recorder's
        frame.passes = {pass("cut", 1 + f, 0.5, at, 10 + at), pass("gather", 2, 0.25, at + 5, 11 + at), pass("cut", 3, 0.5, at + 8, 12 + at)};
        frame.counters.vpls = 7;
        frame.counters.maps = passes::MapCounters{};
        frame.counters.maps->node_views = 1000, frame.counters.maps->cut = 900;
        frame.counters.maps->list_peak = 20, frame.counters.maps->list_capacity = 30;
        frame.peak_bytes = {{"atlas", 1 << 20}, {"lists", 5}};
        run.frames.push_back(frame);
    }
    run.frames[0].passes.push_back(pass("refit", 9, 1, 20, 1));
    return run;
}

TEST(stats, medians) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
    EXPECT_EQ(median({5}), 5);
}

TEST(stats, passes_of_one_name_add_up) {
    const std::vector<PassSum> sums = sum_passes(made_up().frames[0].passes);
    ASSERT_EQ(sums.size(), 3u);
    EXPECT_EQ(sums[0].name, "cut");
    EXPECT_EQ(sums[0].gpu_ms, 4);
    EXPECT_EQ(sums[0].cpu_ms, 1);
    EXPECT_EQ(sums[1].name, "gather");
}

TEST(stats, medians_go_over_the_frames_that_have_the_pass) {
    const std::vector<PassSum> medians = median_passes(made_up().frames);
    ASSERT_EQ(medians.size(), 3u);
    EXPECT_EQ(medians[0].gpu_ms, 5);  // 4, 5, 6
    EXPECT_EQ(medians[2].name, "refit");
    EXPECT_EQ(medians[2].gpu_ms, 9);
}

TEST(stats, json_has_the_names_of_the_contract) {
    const json j = json::parse(stats_json(made_up()));
    EXPECT_EQ(j["device"]["name"], "Device \"X\"");
    EXPECT_EQ(j["scene"]["triangles"], 12);
    EXPECT_EQ(j["scene"]["samples"], 8);
    EXPECT_EQ(j["host_ms"]["build"], 6);
    ASSERT_EQ(j["frames"].size(), 3u);
    const json& frame = j["frames"][1];
    ASSERT_EQ(frame["passes"].size(), 2u);
    EXPECT_EQ(frame["passes"][0]["name"], "cut");
    EXPECT_EQ(frame["passes"][0]["gpu_ms"], 5);
    EXPECT_EQ(frame["passes"][0]["cpu_ms"], 1);
    const json& counters = frame["counters"];
    for (const char* name : {"node_views", "cut", "list_capacity", "list_peak", "vpls"}) EXPECT_TRUE(counters[name].is_number_unsigned()) << name;
    EXPECT_EQ(counters["peak_bytes"]["atlas"], 1 << 20);
    EXPECT_FALSE(j.contains("exposure"));
}

TEST(stats, what_did_not_run_is_absent) {
    RunRecord run = made_up();
    run.size.samples = 0;
    passes::FrameSettings settings;
    settings.visibility = passes::Visibility::rays;
    run.settings = settings_json(settings, 1);
    for (FrameRun& frame : run.frames) frame.counters = {};
    const json j = json::parse(stats_json(run));
    EXPECT_FALSE(j["scene"].contains("samples"));
    for (const char* name : {"node_views", "cut", "vpls", "list_peak"}) EXPECT_FALSE(j["frames"][0]["counters"].contains(name)) << name;
    for (const char* name : {"epsilon", "append", "map_size"}) EXPECT_FALSE(j["settings"].contains(name)) << name;
    EXPECT_EQ(j["settings"]["visibility"], "rays");
    EXPECT_FALSE(settings_json(settings, 1).contains("compensate"));
    settings.compensate = 3;
    EXPECT_EQ(settings_json(settings, 1).at("compensate"), 3);
    settings.vpls = 0;
    EXPECT_FALSE(settings_json(settings, 1).contains("bounces") || settings_json(settings, 1).contains("compensate"));
}

TEST(stats, table_names_passes_counters_and_files) {
    RunRecord run = made_up();
    run.exposure = 0.5;
    run.files = {"out.exr"};
    const std::string table = stats_table(run);
    for (const char* part : {"gather", "refit", "total", "medians of 3 frames", "7 VPLs", "1000 node-views", "atlas 1.0", "exposure 0.5", "wrote out.exr"})
        EXPECT_TRUE(contains(table, part)) << part << "\n" << table;
}

TEST(stats, metadata_tells_how_to_make_the_image_again) {
    const auto m = image_metadata(made_up());
    EXPECT_EQ(m.at("technique"), "manylods");
    EXPECT_EQ(m.at("seed"), "1");
    EXPECT_EQ(m.at("append"), "scan");
    EXPECT_EQ(m.at("gather"), "subset:256");
    EXPECT_EQ(m.at("vpl_bound"), "0.1");
    EXPECT_EQ(m.at("driver"), "driver 1.2");
    EXPECT_TRUE(m.contains("git_revision") && m.contains("scene") && m.contains("device"));
}

TEST(trace, events_have_the_shape_of_the_format) {
    const json j = json::parse(trace_json(made_up()));
    std::map<int, std::string> tracks;
    size_t gpu = 0, cpu = 0;
    for (const json& event : j["traceEvents"]) {
        ASSERT_TRUE(event["pid"].is_number() && event["tid"].is_number() && event["name"].is_string());
        if (event["ph"] == "M") {
            if (event["name"] == "thread_name") tracks[event["tid"]] = event["args"]["name"];
            continue;
        }
        if (event["ph"] == "C") {
            EXPECT_TRUE(event["args"]["value"].is_number());
            continue;
        }
        ASSERT_EQ(event["ph"], "X");
        EXPECT_GE(event["ts"].get<double>(), 0);
        EXPECT_GT(event["dur"].get<double>(), 0);
        ASSERT_TRUE(tracks.contains(event["tid"])) << "events follow the names of their tracks";
        (tracks[event["tid"]].starts_with("GPU") ? gpu : cpu) += 1;
    }
    EXPECT_EQ(gpu, 10u);
    EXPECT_EQ(cpu, 15u);
}

TEST(trace, nothing_starts_on_the_gpu_before_it_was_recorded) {
    const RunRecord run = made_up();
    const double offset = gpu_offset_ms(run);
    EXPECT_DOUBLE_EQ(offset, 10.5);  // set by the first cut: recorded by 10.5, begun at 0
    for (const FrameRun& frame : run.frames)
        for (const engine::PassTime& p : frame.passes) EXPECT_GE(p.gpu_begin_ms + offset, p.cpu_begin_ms + p.cpu_ms);
}

TEST(trace, a_device_on_the_hosts_clock_stays_where_it_is) {
    RunRecord run = made_up();
    run.device.common_clock = true;
    EXPECT_EQ(gpu_offset_ms(run), 0);
}

TEST(trace, counters_are_list_sizes_and_bytes_a_value_a_frame) {
    const RunRecord run = made_up();
    const json trace = json::parse(trace_json(run));
    std::map<std::string, std::vector<json>> counters;
    for (const json& event : trace["traceEvents"])
        if (event["ph"] == "C") counters[event["name"]].push_back(event);
    ASSERT_EQ(counters["list_peak"].size(), run.frames.size());
    ASSERT_EQ(counters["peak_bytes: atlas"].size(), run.frames.size());
    EXPECT_EQ(counters["peak_bytes: atlas"][0]["args"]["value"], 1 << 20);
    EXPECT_DOUBLE_EQ(counters["list_peak"][0]["ts"], (run.frames[0].host.begin_ms + run.frames[0].host.ms) * 1e3);
}

TEST(trace, devices_without_timestamps_have_no_gpu_events) {
    RunRecord run = made_up();
    for (FrameRun& frame : run.frames)
        for (engine::PassTime& p : frame.passes) p.gpu_ms = p.gpu_begin_ms = 0;
    const json trace = json::parse(trace_json(run));  // a loop over a member of a temporary would outlive it
    for (const json& event : trace["traceEvents"]) EXPECT_TRUE(event["ph"] != "X" || event["tid"] != 3);
}

TEST(finite, counts_broken_pixels_and_names_the_first) {
    Image image;
    image.width = 4, image.height = 3;
    for (const char* name : {"R", "G", "B"}) image.add(name);
    require_finite(image);
    image.channels[2].values[9] = std::numeric_limits<float>::infinity();
    image.channels[0].values[6] = image.channels[1].values[6] = std::numeric_limits<float>::quiet_NaN();
    try {
        require_finite(image);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.exit_status(), 1);
        EXPECT_TRUE(contains(e.what(), "2 of 12 pixels") && contains(e.what(), "at 2,1")) << e.what();
    }
}

}  // namespace
}  // namespace myriad::tools
