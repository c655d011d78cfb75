// Files that nobody vouches for: limits, damaged gzip, ranges beyond the end.
#include "scenes/import/bytes.hpp"

#include <filesystem>
#include <functional>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "engine/error.hpp"

namespace myriad::scenes::importing {
namespace {

Bytes gzip(const Bytes& in) {
    z_stream z{};
    EXPECT_EQ(deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    Bytes out(deflateBound(&z, in.size()));
    z.next_in = const_cast<uint8_t*>(in.data()), z.avail_in = uInt(in.size());
    z.next_out = out.data(), z.avail_out = uInt(out.size());
    EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

TEST(Gunzip, gives_back_what_was_packed) {
    for (size_t size : {0u, 1u, 65535u, 65536u, 65537u, 1000000u}) {
        Bytes in(size);
        for (size_t i = 0; i < size; ++i) in[i] = uint8_t(i * i / 7 + i);
        EXPECT_EQ(gunzip(gzip(in), "x", 1 << 20), in) << size;
    }
}

TEST(Gunzip, leaves_other_bytes_alone) {
    EXPECT_EQ(gunzip({1, 2, 3}, "x", 1), (Bytes{1, 2, 3}));
    EXPECT_EQ(gunzip({}, "x", 1), Bytes{});
    EXPECT_EQ(gunzip({0x1f}, "x", 1), Bytes{0x1f});
}

// The limit itself may be reached, one byte more may not; and a bomb is refused without being unpacked.
TEST(Gunzip, stops_at_the_limit) {
    const Bytes packed = gzip(Bytes(1 << 20));
    EXPECT_EQ(gunzip(packed, "x", 1 << 20).size(), 1u << 20);
    EXPECT_NE(refusal([&] { gunzip(packed, "bomb.gz", (1 << 20) - 1); }).find("bomb.gz: it expands to more than"), std::string::npos);
    EXPECT_NE(refusal([&] { gunzip(packed, "bomb.gz", 0); }).find("expands"), std::string::npos);
}

TEST(Gunzip, refuses_damage) {
    Bytes in(10000);
    for (size_t i = 0; i < in.size(); ++i) in[i] = uint8_t(i * 2654435761u >> 13);
    const Bytes packed = gzip(in);
    for (size_t size : {size_t(2), size_t(9), packed.size() / 2, packed.size() - 1})
        EXPECT_NE(refusal([&] { gunzip(Bytes(packed.begin(), packed.begin() + long(size)), "t.gz", 1 << 20); }).find("end too early"), std::string::npos)
            << size;
    for (size_t at = 0; at < packed.size(); at += 97) {
        Bytes damaged = packed;
        damaged[at] ^= 0x55;
        try {
            gunzip(damaged, "d.gz", 1 << 20);  // some bits of the header mean nothing
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("d.gz: "), std::string::npos);
        }
    }
}

TEST(View, checks_each_range) {
    const Bytes bytes{1, 0, 0, 0, 2, 0, 0, 0, 3};
    const View view(bytes, "file");
    EXPECT_EQ(view.records<uint32_t>(0, 2, "x"), (std::vector<uint32_t>{1, 2}));
    EXPECT_EQ(view.record<uint8_t>(8, "x"), 3);
    EXPECT_TRUE(view.records<uint32_t>(9, 0, "x").empty());
    for (const auto& [offset, count] : std::vector<std::pair<uint64_t, uint64_t>>{
             {0, 3}, {6, 1}, {9, 1}, {10, 0}, {~0ull, 1}, {0, ~0ull}, {4, 0x4000000000000000}, {~0ull - 3, 1}})
        EXPECT_NE(refusal([&] { view.records<uint32_t>(offset, count, "the points"); }).find("file: the points: "), std::string::npos) << offset;
}

TEST(ReadFile, has_a_limit) {
    const auto path = std::filesystem::temp_directory_path() / ("myriad_bytes_" + std::to_string(::getpid()));
    std::ofstream(path) << "12345";
    EXPECT_EQ(read_file(path.string(), 5), (Bytes{'1', '2', '3', '4', '5'}));
    EXPECT_NE(refusal([&] { read_file(path.string(), 4); }).find("more than"), std::string::npos);
    std::filesystem::remove(path);
    EXPECT_NE(refusal([&] { read_file(path.string(), 4); }).find("no such file"), std::string::npos);
    EXPECT_NE(refusal([&] { read_file("/", 4); }).find("no such file"), std::string::npos);
}

}  // namespace
}  // namespace myriad::scenes::importing
