#include "engine/cache.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/temp_folder.hpp"

namespace myriad::engine {
namespace {

namespace fs = std::filesystem;

class CacheTest : public testing::Test {
protected:
    static std::vector<uint32_t> numbers(size_t count, uint32_t from) {
        std::vector<uint32_t> values(count);
        std::iota(values.begin(), values.end(), from);
        return values;
    }
    static void store(Cache& cache, const std::string& name, const std::vector<uint32_t>& first, const std::vector<uint32_t>& second = {}) {
        const Bytes parts[] = {std::as_bytes(std::span(first)), std::as_bytes(std::span(second))};
        cache.store(name, parts);
    }
    static std::vector<uint32_t> copy(const CacheEntry& entry, size_t part) {
        const auto values = entry.array<uint32_t>(part);
        return {values.begin(), values.end()};
    }
    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        for (const auto& file : fs::directory_iterator(folder)) all.push_back(file.path());
        return all;
    }
    fs::path only_file() const {
        EXPECT_EQ(files().size(), 1u);
        return files().at(0);
    }
    static std::string read(const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static void write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

    const TempFolder temporary;
    const fs::path& folder = temporary.path;
};

TEST_F(CacheTest, gives_back_what_was_stored) {
    Cache cache(folder / "made" / "here");
    EXPECT_FALSE(cache.find("a"));
    for (const size_t count : {0, 1, 15, 16, 17, 300000}) {
        store(cache, "a", numbers(count, 7), numbers(3, 1));
        const auto entry = cache.find("a");
        ASSERT_TRUE(entry);
        ASSERT_EQ(entry->parts(), 2u);
        EXPECT_EQ(copy(*entry, 0), numbers(count, 7));
        EXPECT_EQ(copy(*entry, 1), numbers(3, 1));
        EXPECT_EQ(reinterpret_cast<uintptr_t>(entry->part(1).data()) % 64, 0u);
    }
    EXPECT_FALSE(cache.find("b"));
    EXPECT_EQ(cache.found(), 6u);
    EXPECT_EQ(cache.missing(), 2u);
    EXPECT_EQ(cache.damaged(), 0u);
    EXPECT_EQ(cache.problem(), "");
}

TEST_F(CacheTest, arrays_of_another_size_are_not_there) {
    Cache cache(folder);
    store(cache, "a", numbers(3, 0));
    EXPECT_EQ(cache.find("a")->array<uint64_t>(0).size(), 0u) << "12 bytes are no whole number of them";
}

// Each byte of the header, ends of the parts, and every length that a torn write can leave near something that matters.
TEST_F(CacheTest, damage_is_found_removed_and_made_anew) {
    Cache cache(folder);
    store(cache, "a", numbers(100, 7), numbers(40, 1));
    const fs::path file = only_file();
    const std::string whole = read(file);
    std::vector<std::string> damaged;
    const auto flip = [&](size_t at) { damaged.push_back(whole), damaged.back()[at] ^= 0x40; };
    for (size_t at = 0; at < 112; ++at) flip(at);
    for (const size_t at : {128, 527, 576, 735}) flip(at);
    for (const size_t size : {0, 1, 8, 111, 112, 127, 128, 300, 528, 575, 735}) damaged.push_back(whole.substr(0, size));
    for (size_t i = 0; i < damaged.size(); ++i) {
        write(file, damaged[i]);
        const uint64_t before = cache.damaged();
        EXPECT_FALSE(cache.find("a")) << i;
        EXPECT_EQ(cache.damaged(), before + 1) << i;
        EXPECT_FALSE(fs::exists(file)) << i;
    }
    store(cache, "a", numbers(100, 7));
    EXPECT_TRUE(cache.find("a"));
}

TEST_F(CacheTest, an_entry_in_use_outlives_its_file) {
    Cache cache(folder);
    store(cache, "a", numbers(1000, 7));
    const auto entry = cache.find("a");
    store(cache, "a", numbers(5, 100));
    fs::remove_all(folder);
    EXPECT_EQ(copy(*entry, 0), numbers(1000, 7));
    EXPECT_FALSE(cache.find("a"));
    store(cache, "a", numbers(5, 100));
    EXPECT_TRUE(cache.find("a")) << "a folder that was deleted is made again";
}

TEST_F(CacheTest, many_writers_and_readers_see_whole_entries) {
    constexpr int writers = 4, rounds = 60;
    std::vector<pid_t> children;
    for (int w = 0; w < writers; ++w) {
        const pid_t child = fork();
        if (child == 0) {
            Cache cache(folder);
            bool well = true;
            for (int i = 0; i < rounds; ++i) {
                store(cache, "a", numbers(20000, 7));
                if (const auto entry = cache.find("a")) well &= copy(*entry, 0) == numbers(20000, 7);
                if (i % 16 == w) fs::remove(folder / "a.derived");
            }
            _exit(well && cache.damaged() == 0 && cache.problem().empty() ? 0 : 1);
        }
        children.push_back(child);
    }
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_LE(files().size(), 1u) << "no temporary is left";
}

TEST_F(CacheTest, what_was_not_used_for_longest_goes_first) {
    Cache cache(folder, 30000);
    for (const char* name : {"a", "b", "c"}) store(cache, name, numbers(2000, 7));
    EXPECT_EQ(files().size(), 3u);
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(10);
    for (const int age : {0, 1, 2}) fs::last_write_time(folder / ("cba"[age] + std::string(".derived")), long_ago - std::chrono::hours(age));
    EXPECT_TRUE(cache.find("a")) << "the oldest, but used now";
    store(cache, "d", numbers(2000, 7));
    EXPECT_TRUE(cache.find("a"));
    EXPECT_FALSE(cache.find("b"));
    EXPECT_TRUE(cache.find("c"));
    EXPECT_TRUE(cache.find("d"));
    store(cache, "huge", numbers(20000, 7));
    EXPECT_FALSE(cache.find("huge")) << "more than the limit is not kept";
    EXPECT_TRUE(cache.find("a")) << "and drives nothing out";
}

TEST_F(CacheTest, what_killed_runs_left_is_swept_and_other_files_are_not) {
    Cache cache(folder);
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
    for (const char* name : {".x.tmp-1-0", "notes.txt"}) write(folder / name, "x"), fs::last_write_time(folder / name, long_ago);
    write(folder / ".y.tmp-1-0", "being written");
    store(cache, "a", numbers(5, 7));
    EXPECT_FALSE(fs::exists(folder / ".x.tmp-1-0"));
    EXPECT_TRUE(fs::exists(folder / ".y.tmp-1-0"));
    EXPECT_TRUE(fs::exists(folder / "notes.txt"));
}

TEST_F(CacheTest, a_folder_that_cannot_be_made_is_a_problem_and_no_error) {
    write(folder / "file", "x");
    Cache cache(folder / "file" / "cache");
    EXPECT_FALSE(cache.find("a"));
    store(cache, "a", numbers(5, 7));
    EXPECT_NE(cache.problem().find((folder / "file" / "cache").string()), std::string::npos) << cache.problem();
    EXPECT_NE(cache.problem().find("--cache"), std::string::npos);
    EXPECT_EQ(cache.problem().find('\n'), std::string::npos);
    EXPECT_FALSE(cache.find("a"));
}

TEST_F(CacheTest, what_is_no_file_is_not_read) {
    Cache cache(folder);
    fs::create_directory(folder / "a.derived");
    EXPECT_FALSE(cache.find("a"));
    ASSERT_EQ(mkfifo((folder / "b.derived").c_str(), 0600), 0);
    EXPECT_FALSE(cache.find("b")) << "a pipe without a writer would wait for ever";
}

TEST(default_cache_folder, follows_the_environment) {
    const auto set = [](const char* name, const char* value) { value ? setenv(name, value, 1) : unsetenv(name); };
    const auto with = [&](const char* own, const char* xdg, const char* home) {
        const std::pair<const char*, const char*> wanted[] = {{"MYRIAD_CACHE", own}, {"XDG_CACHE_HOME", xdg}, {"HOME", home}};
        std::vector<std::pair<const char*, std::optional<std::string>>> before;
        for (const auto& [name, value] : wanted) {
            const char* now = std::getenv(name);
            before.emplace_back(name, now ? std::optional<std::string>(now) : std::nullopt);
            set(name, value);
        }
        const fs::path folder = default_cache_folder();
        for (const auto& [name, value] : before) set(name, value ? value->c_str() : nullptr);
        return folder;
    };
    EXPECT_EQ(with("/a", "/b", "/c"), "/a");
    EXPECT_EQ(with("off", "/b", "/c"), "");
    EXPECT_EQ(with(nullptr, "/b", "/c"), "/b/myriad/derived");
    EXPECT_EQ(with("", "", "/c"), "/c/.cache/myriad/derived");
    EXPECT_EQ(with(nullptr, nullptr, nullptr), "");
}

}  // namespace
}  // namespace myriad::engine
