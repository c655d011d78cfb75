#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

#include "tools/profiler_layer/trace.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::profiler {
namespace {

TEST(ProfilerTrace, IsJsonWhateverNamesHold) {
    Trace trace;
    const std::string name = "a \"b\" \\ \n\t c, \xc3\xa4";
    trace.span(trace.track(name, 3), Kind::region, name, 2e6, 1500, 4);
    trace.counter("bytes", 3e6, 123456789012.0);
    trace.note("lost", 2), trace.note("lost", 3);
    const auto json = nlohmann::json::parse(trace.json());
    EXPECT_EQ(json["traceEvents"][1]["args"]["name"], name);
    EXPECT_EQ(json["traceEvents"][2]["args"]["sort_index"], 3);
    const auto& span = json["traceEvents"][3];
    EXPECT_EQ(span["name"], name);
    EXPECT_EQ(span["cat"], "region");
    EXPECT_EQ(span["ts"], 0);  // times begin with what came first
    EXPECT_EQ(span["dur"], 1.5);
    EXPECT_EQ(span["args"]["frame"], 4);
    const auto& counter = json["traceEvents"][4];
    EXPECT_EQ(counter["ts"], 1000);
    EXPECT_EQ(counter["args"]["value"], 123456789012.0);
    EXPECT_EQ(json["otherData"]["lost"], 5);
}

TEST(ProfilerTrace, ArrowsHaveTwoEndsOfOneNumber) {
    Trace trace;
    const uint32_t host = trace.track("host", 0), device = trace.track("device", 1);
    EXPECT_EQ(trace.track("host", 9), host);
    trace.span(host, Kind::submission, "submit", 0, 100, 0);
    trace.arrow(host, 0, device, 5000);
    const auto json = nlohmann::json::parse(trace.json());
    const auto &from = json["traceEvents"][6], &to = json["traceEvents"][7];
    EXPECT_EQ(from["ph"], "s");
    EXPECT_EQ(to["ph"], "f");
    EXPECT_EQ(from["id"], to["id"]);
    EXPECT_EQ(from["tid"], host + 1);
    EXPECT_EQ(to["tid"], device + 1);
    EXPECT_EQ(to["ts"], 5.0);
}

TEST(ProfilerTrace, SummaryHasMediansAndTotalsDevicesFirst) {
    Trace trace;
    const uint32_t track = trace.track("t", 0);
    trace.span(track, Kind::submission, "submit", 0, 1e6, 0);
    for (const double ms : {4.0, 1.0, 10.0, 2.0}) trace.span(track, Kind::region, "a, \"b\"", 0, ms * 1e6, 0);
    trace.span(track, Kind::frame, "frame", 0, 3e6, 0);
    EXPECT_EQ(trace.csv(),
              "kind,name,count,median_ms,total_ms,min_ms,max_ms\n"
              "frame,frame,1,3.000000,3.000000,3.000000,3.000000\n"
              "region,\"a, \"\"b\"\"\",4,3.000000,17.000000,1.000000,10.000000\n"
              "submission,submit,1,1.000000,1.000000,1.000000,1.000000\n");
}

TEST(ProfilerTrace, FilesAreWrittenBesideAndRenamed) {
    const tools::TempFolder folder;
    const std::string path = folder / "file";
    EXPECT_EQ(write_whole(path, "old"), "");
    const std::filesystem::path link = folder / "link";
    std::filesystem::create_hard_link(path, link);  // still the old file after a rename; overwriting in place would change it
    EXPECT_EQ(write_whole(path, "new"), "");
    std::string now, before;
    std::ifstream(path) >> now, std::ifstream(link) >> before;
    EXPECT_EQ(now, "new");
    EXPECT_EQ(before, "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()), {}), 2);
    EXPECT_NE(write_whole(folder / "absent/file", "x").find("could not be written"), std::string::npos);
}

}  // namespace
}  // namespace myriad::profiler
