#include "engine/digest.hpp"

#include <cstring>
#include <set>

#include <gtest/gtest.h>

namespace myriad::engine {
namespace {

Bytes of(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(digest, is_sha256_of_lengths_and_pieces) {
    // By Python's hashlib: SHA-256 of { SHA-256("abc"), SHA-256(the length 3 in 8 bytes) }.
    const std::string abc = "abc";
    const Bytes parts[] = {of(abc)};
    EXPECT_EQ(hex(digest(parts)), "67cb5c130b9d167158d74ea999351926efeb6b0a2547794e324477ffbc6daede");
}

TEST(digest, differs_when_anything_does) {
    const std::string big(3 << 20, 'x'), longer = big + "x";
    std::string changed = big;
    changed[2 << 20] ^= 1;
    const std::string a = "ab", b = "c", c = "a", d = "bc", empty;
    std::set<Digest> all;
    size_t count = 0;
    const auto add = [&](std::vector<Bytes> parts) { all.insert(digest(parts)), ++count; };
    add({}), add({of(empty)}), add({of(empty), of(empty)});
    add({of(a), of(b)}), add({of(c), of(d)}), add({of(b), of(a)}), add({of(a)}), add({of(a), of(b), of(empty)});
    add({of(big)}), add({of(longer)}), add({of(changed)});
    EXPECT_EQ(all.size(), count);
}

TEST(digest, does_not_depend_on_threads) {
    for (const size_t size : {size_t(0), size_t(1), (size_t(1) << 20) - 1, size_t(1) << 20, (size_t(1) << 20) + 1, size_t(5) << 20}) {
        const std::string text(size, 'y');
        const Bytes parts[] = {of(text)};
        for (const uint32_t threads : {2, 7}) EXPECT_EQ(digest(parts, 1), digest(parts, threads)) << size;
    }
}

TEST(program_id, is_what_the_linker_wrote) { EXPECT_EQ(program_id().size(), 20u) << "--build-id=sha1"; }

}  // namespace
}  // namespace myriad::engine
