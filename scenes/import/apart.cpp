#include "scenes/import/apart.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include <nlohmann/json.hpp>

#include "engine/error.hpp"
#include "scenes/gltf.hpp"
#include "scenes/gltf/write.hpp"
#include "scenes/import/tidy.hpp"

// Under AddressSanitizer the address space is a shadow of 20 TB, which no limit suits, and its reports go to stderr.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
#else
constexpr bool sanitized = false;
#endif

namespace myriad::scenes::importing {
namespace {

using nlohmann::json;

// A file descriptor that closes itself.
struct Descriptor {
    int fd = -1;
    explicit Descriptor(int fd = -1) : fd(fd) {}
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    void reset() {
        if (fd >= 0) close(fd);
        fd = -1;
    }
};

void write_all(int fd, const void* bytes, size_t count) {
    const auto* at = static_cast<const char*>(bytes);
    while (count) {
        const ssize_t written = write(fd, at, std::min(count, size_t(1) << 30));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) throw std::bad_alloc();  // memory is what these files are made of
        at += written, count -= size_t(written);
    }
}

// Bytes of memory and seconds of time for each byte and MiB that a file brings.
constexpr uint64_t memory_a_byte = 64, seconds_a_mebibyte = 2;

uint64_t most_memory() {
    const uint64_t machine = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
    return std::max<uint64_t>(machine / 4 * 3, 1ull << 30);
}

// Only the soft limit, which earn_limits() raises later.
void limit(int what, uint64_t value) {
    rlimit now{};
    getrlimit(__rlimit_resource(what), &now);
    const rlimit wanted{std::min<rlim_t>(value, now.rlim_max), now.rlim_max};  // no limit is the greatest number
    setrlimit(__rlimit_resource(what), &wanted);
}

uint64_t address_space() {  // bytes of it that this process has
    unsigned long pages = 0;
    if (FILE* file = fopen("/proc/self/statm", "r")) {
        if (fscanf(file, "%lu", &pages) != 1) pages = 0;
        fclose(file);
    }
    return uint64_t(pages) * uint64_t(sysconf(_SC_PAGESIZE));
}

void confine(const ApartLimits& limits, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);  // it died before that
    for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU}) ::signal(signal, SIG_DFL);  // the program's handlers are the parent's
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, limits.seconds);
    if (sanitized) return;
    limit(RLIMIT_AS, address_space() + limits.memory);
    if (const int null = open("/dev/null", O_RDWR); null >= 0)  // libraries print
        for (int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, fd);
}

// Reads, and tells how it went: a line of JSON to `report`, the scene to `glb`.
void child(int report, int glb, const std::string& path, const ImportOptions& options, const std::function<Imported()>& read) {
    json out;
    try {
        Imported in = read();
        in.crease = options.crease.value_or(in.crease);
        tidy(in.scene, in.crease);
        write_glb(in.scene, [&](const void* bytes, size_t count) { write_all(glb, bytes, count); }, {.quick = true});
        out = {{"unit", in.unit}, {"up", int(in.up)}, {"crease", in.crease}, {"warnings", in.scene.warnings}};
    } catch (const InputError& e) {
        out = {{"error", e.what()}};
    } catch (const std::bad_alloc&) {
        out = {{"memory", true}};
    } catch (const std::exception& e) {
        out = {{"error", path + ": the file cannot be read (" + e.what() + "); export it again."}};
    }
    const std::string text = out.dump(-1, ' ', false, json::error_handler_t::replace);
    write_all(report, text.data(), text.size());
}

std::string read_to_end(int fd, size_t most) {
    std::string out;
    char piece[4096];
    for (;;) {
        const ssize_t got = ::read(fd, piece, sizeof piece);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0 || out.size() > most) return out;
        out.append(piece, size_t(got));
    }
}

}  // namespace

ApartLimits ApartLimits::for_file(uint64_t bytes) {
    ApartLimits out;
    out.memory = std::min(out.memory + memory_a_byte * bytes, most_memory());
    out.seconds += seconds_a_mebibyte * (bytes >> 20);
    return out;
}

void earn_limits(uint64_t bytes) {
    const auto raise = [](int what, uint64_t by, uint64_t most) {
        rlimit now{};
        getrlimit(__rlimit_resource(what), &now);
        if (now.rlim_cur == RLIM_INFINITY || now.rlim_cur >= most) return;
        now.rlim_cur = std::min({rlim_t(now.rlim_cur + by), now.rlim_max, rlim_t(most)});
        setrlimit(__rlimit_resource(what), &now);
    };
    raise(RLIMIT_CPU, 1 + seconds_a_mebibyte * (bytes >> 20), 1u << 20);
    raise(RLIMIT_AS, memory_a_byte * bytes, address_space() + most_memory());
}

Imported read_apart(const std::string& path, const ApartLimits& limits, const ImportOptions& options, const std::function<Imported()>& read) {
    const auto cannot = [&](const char* what) {
        return OutOfMemory(path + ": " + what + " failed (" + std::strerror(errno) + "); close other programs.");
    };
    const Descriptor glb(memfd_create("scene.glb", MFD_CLOEXEC));
    if (glb.fd < 0) throw cannot("a file in memory");
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw cannot("a pipe");
    Descriptor from(ends[0]), to(ends[1]);
    std::fflush(nullptr);
    const pid_t parent = getpid(), reader = fork();
    if (reader < 0) throw cannot("a new process");
    if (reader == 0) {
        confine(limits, parent);
        try {
            child(to.fd, glb.fd, path, options, read);
        } catch (...) {
            _exit(1);
        }
        _exit(0);
    }
    to.reset();
    const std::string text = read_to_end(from.fd, 1 << 20);
    from.reset();
    int status = 0;
    while (waitpid(reader, &status, 0) < 0 && errno == EINTR) {}

    const auto refuse = [&](const std::string& what) { return InputError(path + ": " + what + "."); };
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) throw OutOfMemory(path + ": the system stopped its reader, most likely for want of memory; close other programs.");
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        throw refuse("reading it takes more than " + std::to_string(limits.seconds) + " s of processor time; export it again, or in another format");
    if (!WIFEXITED(status)) throw refuse("the file is damaged, its reader came to grief; export it again, or in another format");
    const json report = json::parse(text, nullptr, false);
    if (!report.is_object() || report.contains("memory"))
        throw refuse("reading it takes more than " + std::to_string(limits.memory >> 20) + " MiB; check the sizes in it, or make it smaller");
    if (report.contains("error")) throw InputError(report.value("error", path));
    Imported out;
    out.scene = load_gltf("/proc/self/fd/" + std::to_string(glb.fd));
    out.scene.name = path;
    out.unit = report.value("unit", 1.0);
    out.up = Axis(std::clamp(report.value("up", 1), 0, 2));
    out.crease = 0;  // done
    auto warnings = report.value("warnings", std::vector<std::string>());
    warnings.insert(warnings.end(), out.scene.warnings.begin(), out.scene.warnings.end());
    out.scene.warnings = std::move(warnings);
    return out;
}

}  // namespace myriad::scenes::importing
