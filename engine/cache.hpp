// Data that took long to make, kept on disk between runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/digest.hpp"

namespace myriad::engine {

// What was stored under a name, read-only, mapped from its file; it stays valid when the file is deleted or replaced.
class CacheEntry {
public:
    CacheEntry(CacheEntry&& other) noexcept;
    CacheEntry& operator=(CacheEntry&&) = delete;
    ~CacheEntry();

    size_t parts() const { return parts_.size(); }
    Bytes part(size_t i) const { return parts_[i]; }
    // Part i as elements, none when it is no whole number of them.
    template <class T>
    std::span<const T> array(size_t i) const {
        const Bytes bytes = part(i);
        if (bytes.size() % sizeof(T)) return {};
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }

private:
    friend class Cache;
    CacheEntry(void* map, size_t size) : map_(map), size_(size) {}
    void* map_;
    size_t size_;
    std::vector<Bytes> parts_;  // each aligned to 64 bytes
};

// A folder of entries, a file each. Safe to delete at any moment; safe for any number of processes, for a file appears whole,
// by a rename, and is never changed. What does not match its own digest is removed and counts as absent. Nothing here ever
// fails a run: what cannot be stored is not, and `problem` says why. Not safe against who may write to the folder: it is the
// user's own.
class Cache {
public:
    // Beyond `limit` bytes, entries that were not used for longest are removed.
    explicit Cache(std::filesystem::path folder, uint64_t limit = uint64_t(4) << 30);

    std::optional<CacheEntry> find(const std::string& name);
    void store(const std::string& name, std::span<const Bytes> parts);

    const std::filesystem::path& folder() const { return folder_; }
    uint64_t found() const { return found_; }        // finds that found
    uint64_t missing() const { return missing_; }    // finds that did not, or damaged
    uint64_t damaged() const { return damaged_; }
    const std::string& problem() const { return problem_; }  // why the first entry that could not be stored was not; or empty

private:
    void trim();

    std::filesystem::path folder_;
    uint64_t limit_, found_ = 0, missing_ = 0, damaged_ = 0;
    std::string problem_;
};

// Where users' caches are: MYRIAD_CACHE, else XDG_CACHE_HOME/myriad/derived, else HOME/.cache/myriad/derived; empty where
// MYRIAD_CACHE is "off" or none of them is set.
std::filesystem::path default_cache_folder();

}  // namespace myriad::engine
