// What the program does when the world fails: memory, device, disk, and whoever kills it. Always: the right exit status, one
// sentence, and each output file as it was or whole and new (spec, section 5). README.md here has the table.
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "scenes/gltf/write.hpp"
#include "tests/program.hpp"
#include "tools/exr.hpp"

namespace myriad::tools {
namespace {

// Up to `most` numbers from 1 to `count`: the first few, the last, and between them further and further apart.
std::set<long> spread(long count, long most) {
    std::set<long> out;
    for (long i = 0; i < most && count > 0; ++i) out.insert(std::max(i + 1, std::lround(std::pow(double(count), double(i + 1) / double(most)))));
    while (!out.empty() && *out.rbegin() > count) out.erase(std::prev(out.end()));
    if (count > 0) out.insert(count);
    return out;
}

class faults : public testing::Test {
protected:
    void SetUp() override {
        Image image;
        image.width = image.height = 64;
        std::mt19937 random(1);
        for (const char* name : {"R", "G", "B"})
            for (float& value : image.add(name)) value = float(random() % 1000) / 1000;
        write_exr(inputs / "a.exr", image);
        for (float& value : image.channels[0].values) value += float(random() % 1000) / 1000;  // a picture of noise, so not a tiny one
        write_exr(inputs / "b.exr", image);
    }

    // Without the validation layer, which allocates too, and without the cache: each run makes the same calls.
    const Environment plain = {{"MYRIAD_VALIDATION", "0"}, {"MYRIAD_CACHE", "off"}};
    Environment with(const std::string& name, const std::string& value) const {
        Environment out = plain;
        out.emplace_back(name, value);
        return out;
    }

    Outcome run(const Arguments& arguments, const std::string& fault = "") {
        return myriad_program(arguments, with("MYRIAD_FAULT", fault), MYRIAD_FAULTY_PROGRAM);
    }

    // How often a run without faults makes each call.
    std::map<std::string, long> counts(const Arguments& arguments) {
        const std::string report = inputs / "counts";
        run(arguments);  // drivers keep what they compile, and what they do before that runs through templates of ours
        const Outcome o = myriad_program(arguments, with("MYRIAD_FAULT_COUNTS", report), MYRIAD_FAULTY_PROGRAM);
        EXPECT_EQ(o.status, 0) << o.err;
        std::map<std::string, long> out;
        std::istringstream lines(bytes_of(report));
        std::string name;
        for (long count = 0; lines >> name >> count;) out[name] = count;
        return out;
    }

    // A run with this fault ends with that status and one sentence, and leaves what there was; or, where the fault comes after
    // an output was finished, `whole` of it.
    void refuse(int status, const Arguments& arguments, const std::string& fault, const std::string& part, const std::map<std::string, std::string>& whole = {}) {
        auto before = names_and_bytes();
        const Outcome o = run(arguments, fault);
        const auto after = names_and_bytes();
        if (o.status == 0 && contains(fault, "new:") && fault.ends_with(":fail")) {
            // Streams swallow exceptions, and CLI11 writes help texts through them. A run that does not need what is lost does its work.
            for (const auto& [name, bytes] : whole) EXPECT_TRUE(after.contains(name) && same(name, after.at(name), bytes)) << fault << ": " << name;
            EXPECT_EQ(o.err, "") << fault;
            return;
        }
        for (const auto& [name, bytes] : whole)
            if (const auto now = after.find(name); now != after.end() && same(name, now->second, bytes)) before[name] = now->second;
        const std::string what = fault + ": " + testing::PrintToString(arguments) + "\n" + o.err;
        EXPECT_EQ(o.status, status) << what;
        EXPECT_EQ(o.error_lines(), 1) << what;
        EXPECT_TRUE(o.err.starts_with("error: ") && contains(o.err, part)) << what;
        EXPECT_TRUE(after == before) << what << testing::PrintToString(folder.names());
    }

    // Reports hold times, which differ from run to run: these are whole when they end as they end.
    static bool same(const std::string& name, const std::string& now, const std::string& whole) {
        return name.ends_with(".json") ? now.ends_with("}\n") : now == whole;
    }

    std::map<std::string, std::string> names_and_bytes() const {
        std::map<std::string, std::string> out;
        for (const std::string& name : folder.names()) out[name] = bytes_of(folder / name);
        return out;
    }

    TempFolder inputs, folder;
    // Names so long that those of temporaries, which end in the process's number, are on the heap however many digits it has: allocations
    // are counted, and the count of one run is used in another.
    const std::string exr = folder / "picture.exr", png = folder / "picture.png", glb = folder / "picture.glb";
    const Arguments render = tiny + Arguments{"-o", exr, "--png", png, "--stats", folder / "statistics.json"};
    const Arguments compare = {"compare", inputs / "a.exr", inputs / "b.exr", "--diff", png};
    const Arguments convert = {"convert", "builtin:cornell?cells=1", glb, "-q"};
};

// ---- memory

TEST_F(faults, host_memory) {
    const std::string part = "memory";
    for (const auto& [arguments, most] : {std::pair(compare, 40L), {convert, 40L}, {render, 5L}}) {
        const long count = counts(arguments)["new"];
        EXPECT_GT(count, 20);
        const auto whole = names_and_bytes();
        bool once = false;
        for (const long n : spread(count, most)) {
            for (const auto& [name, bytes] : whole) put(folder / name, "old");
            refuse(3, arguments, "new:" + std::to_string(n) + ((once = !once) ? ":fail" : ":fail-on"), part, whole);
        }
    }
}

TEST_F(faults, host_memory_while_a_file_is_read) {
    const std::string scene = inputs / "scene.glb";
    put(scene, scenes::glb_bytes(scenes::load("builtin:cornell?cells=1")));
    const Arguments arguments = {"convert", scene, glb, "-q"};
    if (run(arguments).status != 0) GTEST_SKIP() << "convert does not read .glb";
    const long count = counts(arguments)["new"];
    const auto whole = names_and_bytes();
    for (const long n : spread(count, 40)) {
        std::filesystem::remove(glb);
        refuse(3, arguments, "new:" + std::to_string(n) + (n % 2 ? ":fail" : ":fail-on"), "memory", whole);
    }
}

// The address space ends, so that libraries meet it too: a driver that is out of memory may do anything but leave half a file.
TEST_F(faults, address_space) {
    put(png, "old");
    for (const long mib : {60, 80, 100, 150, 250}) {
        const pid_t child = fork();
        if (child == 0) {
            const rlimit limit{rlim_t(mib) << 20, rlim_t(mib) << 20};
            setrlimit(RLIMIT_AS, &limit);
            const Outcome o = run(compare);
            _exit(o.status == 0 || (o.status == 3 && o.error_lines() == 1) || o.status == 127 ? 0 : 1);  // 127: it does not even start
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status_of(status), 0) << mib << " MiB";
        const std::vector<std::string> names = folder.names();
        EXPECT_EQ(names, std::vector<std::string>{"picture.png"}) << mib << " MiB";
    }
}

TEST_F(faults, device_memory) {
    const auto made = counts(render);
    for (const std::string& name : folder.names()) put(folder / name, "old");
    for (const char* call : {"vkAllocateMemory", "vkCreateBuffer"}) {
        EXPECT_GT(made.at(call), 10);
        for (const long n : spread(made.at(call), 2))
            for (const char* result : {"-2", "-1"})  // VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY
                if (result[1] == '2' || n % 3 == 0) refuse(3, render, std::string(call) + ":" + std::to_string(n) + ":" + result, "out of memory");
    }
    refuse(3, render, "vkCreateComputePipelines:2:-1", "out of memory");
}

// ---- device

TEST_F(faults, device_lost) {
    const auto made = counts(render);
    for (const std::string& name : folder.names()) put(folder / name, "old");
    for (const char* call : {"vkQueueSubmit2", "vkWaitForFences"}) {
        EXPECT_GT(made.at(call), 3);
        for (const long n : spread(made.at(call), 2)) refuse(3, render, std::string(call) + ":" + std::to_string(n) + ":-4", "the device was lost");
    }
    refuse(3, render, "vkCreateComputePipelines:3:-3", "VkResult -3");
}

// ---- disk

// Each call that makes a file fails in turn: a full disk, a quota, a broken disk, a vanished folder.
TEST_F(faults, each_call_of_an_output) {
    auto made = counts(compare);
    const std::string whole = bytes_of(png);
    size_t refused = 0;
    for (const char* call : {"open", "fwrite", "fflush", "fsync", "fclose", "rename"})
        for (long n = 1; n <= made[call]; ++n)
            for (const int error : {ENOSPC, EIO, ENOENT}) {
                put(png, "old");
                const std::string fault = std::string(call) + ":" + std::to_string(n) + ":" + std::to_string(error);
                const Outcome o = run(compare, fault);
                const std::string now = bytes_of(png);
                EXPECT_EQ(folder.names(), Arguments{"picture.png"}) << fault;
                if (o.status == 0) {  // what may fail without harm comes after the file's own call: making the rename durable
                    EXPECT_TRUE(now == whole && n > 1) << fault;
                    continue;
                }
                EXPECT_EQ(o.status, 2) << fault << o.err;
                EXPECT_EQ(o.error_lines(), 1) << fault << o.err;
                EXPECT_TRUE(contains(o.err, "cannot write")) << fault << o.err;
                EXPECT_TRUE(now == "old" || now == whole) << fault;
                EXPECT_TRUE(error != ENOSPC || now == whole || contains(o.err, "the disk is full; free some space")) << fault << o.err;
                ++refused;
            }
    EXPECT_GT(refused, 10u);
}

// In a mount namespace of its own, for those who may have one (root, and users where the system allows it): the exit status of
// the action, with `options` for a new tmpfs over `folder`.
template <class Action>
int with_mount(const std::filesystem::path& folder, const char* options, const Action& action) {
    constexpr int unable = 77;
    const pid_t child = fork();
    if (child == 0) {
        if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) _exit(unable);
        if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 || mount("tmpfs", folder.c_str(), "tmpfs", 0, options) != 0) _exit(unable);
        action();
        _exit(testing::Test::HasFailure() ? 1 : 0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status_of(status);
}

TEST_F(faults, a_disk_that_is_really_full) {
    const int status = with_mount(folder.path, "size=12k", [&] {
        put(png, "old"), put(exr, "old");
        put(folder / "ballast", std::string(4096, 'x'));  // three pages in all: nothing is left
        refuse(2, compare, "", "the disk is full; free some space");
        refuse(2, tiny + Arguments{"-o", exr}, "", "the disk is full; free some space");
    });
    if (status == 77) GTEST_SKIP() << "mounting is not allowed here";
    EXPECT_EQ(status, 0);
}

TEST_F(faults, a_read_only_file_system) {
    const int status = with_mount(folder.path, "size=64k", [&] {
        put(png, "old");
        ASSERT_EQ(mount("none", folder.path.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
        for (const Arguments& arguments : {compare, convert, render}) refuse(2, arguments, "", "cannot write");
    });
    if (status == 77) GTEST_SKIP() << "mounting is not allowed here";
    EXPECT_EQ(status, 0);
}

TEST_F(faults, a_limit_on_the_size_of_files) {  // whose signal ends programs that do not know it
    put(png, "old");
    const pid_t child = fork();
    if (child == 0) {
        const rlimit limit{1000, 1000};
        setrlimit(RLIMIT_FSIZE, &limit);
        refuse(2, compare, "", "larger than the system allows");
        _exit(testing::Test::HasFailure() ? 1 : 0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status_of(status), 0);
}

// ---- signals

// Killed or interrupted before and after each call that makes a file.
TEST_F(faults, ended_at_each_call_of_an_output) {
    auto made = counts(compare);
    const std::string whole = bytes_of(png);
    for (const char* call : {"open", "fwrite", "fflush", "fsync", "fclose", "rename"})
        for (long n = 1; n <= made[call]; ++n)
            for (const char* action : {"kill-before", "kill-after", "interrupt-before", "interrupt-after"}) {
                put(png, "old");
                const std::string fault = std::string(call) + ":" + std::to_string(n) + ":" + action;
                const bool killed = action[0] == 'k';
                const Outcome o = run(compare, fault);
                EXPECT_EQ(o.status, 128 + (killed ? SIGKILL : SIGINT)) << fault << o.err;
                const std::string now = bytes_of(png);
                EXPECT_TRUE(now == "old" || now == whole) << fault;
                for (const std::string& name : folder.names()) {
                    const bool temporary = name.starts_with(".picture.png.tmp-");  // nobody can clean up after SIGKILL
                    EXPECT_TRUE(name == "picture.png" || (killed && temporary)) << fault << ": " << name;
                    if (temporary) std::filesystem::remove(folder / name);
                }
            }
}

// At any moment of a render with three outputs.
TEST_F(faults, ended_at_random_moments) {
    const auto start_time = std::chrono::steady_clock::now();
    ASSERT_EQ(run(render).status, 0);
    const auto whole = names_and_bytes();
    const auto span = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start_time).count();
    std::mt19937 random(5);
    for (int i = 0; i < 6; ++i) {
        const int sent = i % 2 ? SIGKILL : SIGINT;
        for (const auto& [name, bytes] : whole) put(folder / name, "old");
        const TempFolder pipes;
        const pid_t child = start(render, plain, pipes / "out", pipes / "err");
        std::this_thread::sleep_for(std::chrono::microseconds(random() % span));
        kill(child, sent);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(status_of(status) == 128 + sent || status_of(status) == 0) << status_of(status) << bytes_of(pipes / "err");
        for (const auto& [name, bytes] : whole) {
            const std::string now = bytes_of(folder / name);
            EXPECT_TRUE(now == "old" || same(name, now, bytes)) << name << " after " << sent;
        }
        for (const std::string& name : folder.names()) {
            EXPECT_TRUE(whole.contains(name) || (sent == SIGKILL && name.starts_with("."))) << name;
            if (!whole.contains(name)) std::filesystem::remove(folder / name);
        }
    }
}

TEST_F(faults, a_reader_that_goes_away) {  // myriad info | head -1
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    close(ends[0]);
    const pid_t child = start(compare, {}, inputs / "out", "", ends[1]);
    close(ends[1]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status_of(status), 0);
    EXPECT_EQ(folder.names(), Arguments{"picture.png"});
}

}  // namespace
}  // namespace myriad::tools
