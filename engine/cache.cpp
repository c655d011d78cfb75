#include "engine/cache.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace myriad::engine {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_parts = 8, alignment = 64;
constexpr char suffix[] = ".derived";

// A file is this, then each part at the next multiple of 64 bytes.
struct Header {
    std::array<char, 8> magic{'m', 'y', 'r', 'i', 'a', 'd', '0', '1'};
    uint64_t parts = 0;
    std::array<uint64_t, most_parts> sizes{};
    Digest digest{};  // of the parts
};
static_assert(sizeof(Header) % 8 == 0);

constexpr uint64_t aligned(uint64_t offset) { return (offset + alignment - 1) / alignment * alignment; }

struct File {
    int descriptor;
    explicit File(int descriptor) : descriptor(descriptor) {}
    File(const File&) = delete;
    ~File() {
        if (descriptor >= 0) close(descriptor);
    }
    // errno of the first failure, or 0.
    int write_all(Bytes bytes) {
        while (!bytes.empty()) {
            const ssize_t done = write(descriptor, bytes.data(), std::min<size_t>(bytes.size(), 1 << 30));
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return done < 0 ? errno : EIO;
            bytes = bytes.subspan(size_t(done));
        }
        return 0;
    }
};

// The parts of a mapped file; nullopt unless its header fits its size and its digest its parts.
std::optional<std::vector<Bytes>> whole_parts(Bytes file) {
    Header header;
    if (file.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, file.data(), sizeof header);
    if (header.magic != Header().magic || header.parts > most_parts) return std::nullopt;
    std::vector<Bytes> parts;
    uint64_t at = aligned(sizeof header);
    for (size_t i = 0; i < header.parts; ++i) {
        if (at > file.size() || header.sizes[i] > file.size() - at) return std::nullopt;
        parts.push_back(file.subspan(at, header.sizes[i]));
        at = aligned(at + header.sizes[i]);
    }
    for (size_t i = header.parts; i < most_parts; ++i)
        if (header.sizes[i]) return std::nullopt;
    if (at != file.size() || digest(parts) != header.digest) return std::nullopt;
    return parts;
}

}  // namespace

CacheEntry::CacheEntry(CacheEntry&& other) noexcept
    : map_(std::exchange(other.map_, nullptr)), size_(other.size_), parts_(std::move(other.parts_)) {}

CacheEntry::~CacheEntry() {
    if (map_) munmap(map_, size_);
}

Cache::Cache(fs::path folder, uint64_t limit) : folder_(std::move(folder)), limit_(limit) {}

std::optional<CacheEntry> Cache::find(const std::string& name) {
    ++missing_;  // until it is found
    const fs::path path = folder_ / (name + suffix);
    const File file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe is not waited for
    struct stat status;
    if (file.descriptor < 0 || fstat(file.descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    const auto damaged = [&] {
        ++damaged_;
        unlink(path.c_str());
        return std::nullopt;
    };
    if (status.st_size == 0) return damaged();
    void* map = mmap(nullptr, size_t(status.st_size), PROT_READ, MAP_PRIVATE | MAP_POPULATE, file.descriptor, 0);
    if (map == MAP_FAILED) return std::nullopt;
    CacheEntry entry(map, size_t(status.st_size));
    auto parts = whole_parts({static_cast<const std::byte*>(map), entry.size_});
    if (!parts) return damaged();
    entry.parts_ = std::move(*parts);
    futimens(file.descriptor, nullptr);  // used now; where that is not allowed, it counts as older than it is
    --missing_, ++found_;
    return entry;
}

void Cache::store(const std::string& name, std::span<const Bytes> parts) {
    assert(parts.size() <= most_parts);
    static std::atomic<unsigned> number = 0;  // of temporaries of this process
    Header header;
    header.parts = parts.size();
    uint64_t size = aligned(sizeof header);
    for (size_t i = 0; i < parts.size(); ++i) header.sizes[i] = parts[i].size(), size = aligned(size + parts[i].size());
    if (size > limit_) return;
    header.digest = digest(parts);

    const fs::path path = folder_ / (name + suffix);
    const fs::path temporary = folder_ / ("." + name + ".tmp-" + std::to_string(getpid()) + "-" + std::to_string(number++));
    const auto write = [&]() -> int {
        std::error_code error;
        fs::create_directories(folder_, error);
        if (error) return error.value();
        File file(open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
        if (file.descriptor < 0) return errno;
        const auto put = [&](Bytes bytes) {
            static constexpr std::byte zeros[alignment] = {};
            const int failed = file.write_all(bytes);
            return failed ? failed : file.write_all(std::span(zeros).first(aligned(bytes.size()) - bytes.size()));
        };
        if (const int failed = put(std::as_bytes(std::span(&header, 1)))) return failed;
        for (const Bytes part : parts)
            if (const int failed = put(part)) return failed;
        // Not synced: what a power failure leaves of it does not match its digest.
        return rename(temporary.c_str(), path.c_str()) == 0 ? 0 : errno;
    };
    if (const int failed = write()) {
        unlink(temporary.c_str());
        if (problem_.empty())
            problem_ = "nothing is kept in the cache '" + folder_.string() + "': " + std::strerror(failed) +
                       "; name another folder with --cache, or --cache off";
        return;
    }
    trim();
}

// Removes what was not used for longest while there is too much, and what killed runs left an hour ago or more.
void Cache::trim() {
    struct Found {
        fs::file_time_type used;
        fs::path path;
        uint64_t size;
    };
    std::vector<Found> entries;
    uint64_t sum = 0;
    std::error_code error;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        std::error_code gone;  // another process trims, too
        const std::string file = at->path().filename();
        const Found found{at->last_write_time(gone), at->path(), gone ? 0 : at->file_size(gone)};
        if (gone) continue;
        if (file.starts_with(".") && file.find(".tmp-") != file.npos && fs::file_time_type::clock::now() - found.used > std::chrono::hours(1))
            fs::remove(found.path, gone);
        if (!file.ends_with(suffix)) continue;
        entries.push_back(found);
        sum += found.size;
    }
    std::sort(entries.begin(), entries.end(), [](const Found& a, const Found& b) { return a.used < b.used; });
    for (const Found& entry : entries) {
        if (sum <= limit_) break;
        std::error_code gone;
        fs::remove(entry.path, gone);
        sum -= entry.size;
    }
}

fs::path default_cache_folder() {
    const auto set = [](const char* name) -> std::string {
        const char* value = std::getenv(name);
        return value ? value : "";
    };
    if (const std::string folder = set("MYRIAD_CACHE"); !folder.empty()) return folder == "off" ? "" : folder;
    if (const std::string folder = set("XDG_CACHE_HOME"); !folder.empty()) return fs::path(folder) / "myriad" / "derived";
    if (const std::string home = set("HOME"); !home.empty()) return fs::path(home) / ".cache" / "myriad" / "derived";
    return {};
}

}  // namespace myriad::engine
