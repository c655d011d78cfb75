// Files that nobody vouches for: read whole within a limit, and looked into only after each range has been checked.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace myriad::scenes::importing {

using Bytes = std::vector<uint8_t>;

// Where a format sets no limit of its own: a file that is larger, or expands to more, is refused.
inline constexpr uint64_t max_file_bytes = 2ull << 30;

// The whole file; InputError if it cannot be read or is larger than `limit` bytes.
Bytes read_file(const std::string& path, uint64_t limit);

// The contents of a gzip file, or `bytes` themselves where they do not begin like one. InputError where they expand beyond
// `limit` bytes: a file of 1 MB can hold 1 GB.
Bytes gunzip(Bytes bytes, const std::string& name, uint64_t limit);

// Bytes of a file, and how to refuse it. The machine must be little-endian, as the formats are.
class View {
public:
    View(std::span<const uint8_t> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

    size_t size() const { return bytes_.size(); }
    const std::string& name() const { return name_; }
    // Throws InputError: "NAME: WHAT; CURE."
    [[noreturn]] void fail(const std::string& what, const std::string& cure = "the file is damaged, get it again") const;

    // `count` records from byte `offset` on. Each of them is what the file holds there, whatever that may mean.
    template <class T>
    std::vector<T> records(uint64_t offset, uint64_t count, const std::string& what) const {
        static_assert(std::is_trivially_copyable_v<T>);
        check(offset, count, sizeof(T), what);
        std::vector<T> out(count);
        if (count) std::memcpy(out.data(), bytes_.data() + offset, count * sizeof(T));
        return out;
    }
    template <class T>
    T record(uint64_t offset, const std::string& what) const {
        static_assert(std::is_trivially_copyable_v<T>);
        check(offset, 1, sizeof(T), what);
        T out;
        std::memcpy(&out, bytes_.data() + offset, sizeof out);
        return out;
    }

private:
    void check(uint64_t offset, uint64_t count, uint64_t size, const std::string& what) const;

    std::span<const uint8_t> bytes_;
    std::string name_;
};

}  // namespace myriad::scenes::importing
