// Whatever a reader does apart, here it is one sentence.
#include "scenes/import/apart.hpp"

#include <csignal>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include <unistd.h>

#include <gtest/gtest.h>

#include "engine/error.hpp"

namespace myriad::scenes::importing {
namespace {

Imported triangle() {
    Imported in;
    in.scene.materials.push_back({.name = "clay"});
    in.scene.meshes.push_back({"tri", {{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .indices = {0, 1, 2}}}});
    in.scene.instances.push_back({});
    in.scene.warnings = {"first."};
    in.unit = 0.5, in.up = Axis::z;
    return in;
}

Imported apart(const std::function<Imported()>& read, ApartLimits limits = {}) { return read_apart("given.obj", limits, {}, read); }

std::string refused(const std::function<Imported()>& read, ApartLimits limits = {}) {
    try {
        apart(read, limits);
    } catch (const InputError& e) {
        const std::string message = e.what();
        EXPECT_EQ(message.find("given.obj: "), 0u) << message;
        EXPECT_EQ(message.back(), '.') << message;
        return message;
    }
    return "(accepted)";
}

TEST(Apart, TheSceneComesBack) {
    const Imported out = apart(triangle);
    ASSERT_EQ(out.scene.instances.size(), 1u);
    EXPECT_EQ(out.scene.name, "given.obj");
    EXPECT_EQ(out.scene.meshes[0].name, "tri");
    EXPECT_EQ(out.scene.meshes[0].primitives[0].normals.size(), 3u);  // tidied there
    EXPECT_EQ(out.unit, 0.5);
    EXPECT_EQ(out.up, Axis::z);
    EXPECT_EQ(out.scene.warnings, std::vector<std::string>{"first."});
}

TEST(Apart, ErrorsComeBack) {
    EXPECT_EQ(refused([]() -> Imported { throw InputError("given.obj: it is green; paint it."); }), "given.obj: it is green; paint it.");
    EXPECT_NE(refused([]() -> Imported { throw std::out_of_range("vector::at"); }).find("(vector::at)"), std::string::npos);
}

TEST(Apart, CrashesAreErrors) {
#ifndef __SANITIZE_ADDRESS__  // whose own handler reports and exits
    EXPECT_NE(refused([]() -> Imported { std::raise(SIGSEGV), std::abort(); }).find("came to grief"), std::string::npos);
#endif
    EXPECT_NE(refused([]() -> Imported { std::abort(); }).find("came to grief"), std::string::npos);
    refused([]() -> Imported { _exit(3); });
    refused([]() -> Imported { _exit(0); });
}

TEST(Apart, LoopsEnd) {
    volatile bool forever = true;
    ApartLimits limits;
    limits.seconds = 1;
    EXPECT_NE(refused([&] {
                  while (forever) {}
                  return triangle();
              }, limits).find("more than 1 s"), std::string::npos);
}

#ifndef __SANITIZE_ADDRESS__
TEST(Apart, MemoryIsBounded) {
    ApartLimits limits;
    limits.memory = 64 << 20;
    const auto greedy = [] {
        std::vector<std::vector<char>> all;
        for (;;) all.emplace_back(1 << 20, 'x');
        return triangle();
    };
    EXPECT_NE(refused(greedy, limits).find("64 MiB"), std::string::npos);
}

// Sanitised, the child keeps its output, for reports.
TEST(Apart, WhatReadersPrintIsNotSeen) {
    testing::internal::CaptureStdout();
    apart([] {
        std::printf("Progress 100 %%\n");
        std::fflush(stdout);
        return triangle();
    });
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}
#endif

TEST(Apart, LimitsGrowWithTheFile) {
    const ApartLimits small = ApartLimits::for_file(1000), large = ApartLimits::for_file(1ull << 30);
    EXPECT_GT(large.seconds, small.seconds);
    EXPECT_GE(large.memory, small.memory);
    EXPECT_LT(ApartLimits::for_file(~0ull >> 8).memory, 1ull << 50);
}

}  // namespace
}  // namespace myriad::scenes::importing
