#include "engine/parallel.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace myriad::engine {
namespace {

TEST(parallel_pieces, cover_everything_once_whatever_the_threads) {
    for (const size_t count : {0, 1, 99, 100, 101, 12345})
        for (const uint32_t threads : {0, 1, 2, 7, 1000}) {
            std::vector<int> visits(count);
            std::atomic<size_t> pieces = 0;
            parallel_pieces(count, 100, [&](size_t begin, size_t end) {
                EXPECT_EQ(begin % 100, 0u);
                EXPECT_TRUE(end == begin + 100 || end == count);
                ++pieces;
                for (size_t i = begin; i < end; ++i) ++visits[i];
            }, threads);
            EXPECT_EQ(pieces, (count + 99) / 100);
            EXPECT_EQ(visits, std::vector<int>(count, 1)) << count << " on " << threads;
        }
}

TEST(parallel_pieces, the_first_exception_comes_through_and_all_pieces_are_done) {
    for (const uint32_t threads : {1, 2, 8}) {
        std::atomic<int> done = 0;
        try {
            parallel_pieces(50, 1, [&](size_t i, size_t) {
                ++done;
                if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
            }, threads);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const std::runtime_error& e) {
            EXPECT_STREQ(e.what(), "7");
        }
        EXPECT_EQ(done, 50);
    }
}

}  // namespace
}  // namespace myriad::engine
