// What the fuzz targets have met before, and a little of what they might: seeds, findings, and mutations of the seeds that
// are the same every time. Any compiler will do.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <random>

#include <gtest/gtest.h>

#include "tests/fuzz/targets.hpp"

// Inputs of a few kilobytes have no business with allocations like this, those of the libraries included. Not inlined, for
// compilers then see malloc() paired with delete and complain.
[[gnu::noinline]] void* operator new(size_t bytes) {
    if (bytes > size_t(512) << 20) {
        std::fprintf(stderr, "an input asked for %zu bytes at once\n", bytes);
        std::abort();
    }
    if (void* memory = std::malloc(bytes ? bytes : 1)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace myriad::fuzz {
namespace {

class Replay : public testing::TestWithParam<Target> {
protected:
    static void run(const std::string& input) { GetParam().run(reinterpret_cast<const uint8_t*>(input.data()), input.size()); }
};

TEST_P(Replay, Seeds) {
    const std::vector<std::string> inputs = seeds(GetParam().name);
    ASSERT_FALSE(inputs.empty());
    EXPECT_TRUE(inputs == seeds(GetParam().name)) << "the same bytes every time";
    for (const std::string& input : inputs) run(input);
}

// Each once made a target crash, hang or take too much memory.
TEST_P(Replay, Findings) {
    const std::filesystem::path folder = std::filesystem::path(MYRIAD_FINDINGS) / GetParam().name;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "there are none for this target";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path().string());
        std::ifstream in(entry.path(), std::ios::binary);
        run({std::istreambuf_iterator<char>(in), {}});
    }
}

TEST_P(Replay, Mutations) {
    std::mt19937 random(7);
    for (const std::string& seed : seeds(GetParam().name))
        for (int i = 0; i < 60; ++i) {
            std::string input = seed;
            for (uint32_t k = 0; k < 1 + random() % 4; ++k) {
                const size_t at = random() % input.size(), length = std::min<size_t>(1 + random() % 8, input.size() - at);
                switch (random() % 4) {
                    case 0: input[at] = char(random()); break;
                    case 1: input.replace(at, length, length, random() % 2 ? '\xff' : '\0'); break;
                    case 2: input.erase(at, length); break;
                    default: input.insert(at, input.substr(random() % input.size(), length)); break;
                }
                if (input.empty()) break;
            }
            run(input);
        }
}

INSTANTIATE_TEST_SUITE_P(each, Replay, testing::ValuesIn(targets), [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace myriad::fuzz
