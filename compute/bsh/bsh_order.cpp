#include "compute/bsh/bsh_order.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <thread>

#include "compute/common/radix_sort.hpp"
#include "engine/parallel.hpp"

namespace myriad::compute {
namespace {

constexpr size_t grain = 1 << 14;  // points that a thread takes at a time

struct Point {
    glm::vec3 position;
    uint32_t index;
};

// The three orders hold whole points, not indices: every pass over them is then a stream.
struct Splitter {
    std::vector<Point> order[3], spare;
    std::vector<uint8_t> in_left;  // by point index; subtrees own disjoint points, so threads never meet

    // The volume of the sphere around the points' box (without the constant): its diagonal cubed. Nodes are spheres, and
    // unlike the volume of the box it tells flat sets apart, and thin ones: walls and floors are most of a scene.
    static double volume(const Point* points, size_t count) {
        glm::vec3 low = points[0].position, high = low;
        for (size_t i = 1; i < count; ++i) low = glm::min(low, points[i].position), high = glm::max(high, points[i].position);
        const glm::dvec3 extent = glm::dvec3(high) - glm::dvec3(low);
        const double squared = extent.x * extent.x + extent.y * extent.y + extent.z * extent.z;
        return squared * std::sqrt(squared);
    }

    void split(size_t first, size_t count, uint32_t threads) {
        if (count == 1) return;
        const size_t half = count / 2;
        int best = 0;
        double least = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double sum = volume(&order[axis][first], half) + volume(&order[axis][first + half], half);
            if (axis == 0 || sum < least) least = sum, best = axis;
        }
        for (size_t i = 0; i < count; ++i) in_left[order[best][first + i].index] = i < half;
        // Both other orders are partitioned stably, so that they stay sorted (Wald and Havran 2006).
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == best) continue;
            Point *from = &order[axis][first], *left = from, *right = &spare[first];
            for (size_t i = 0; i < count; ++i) {
                const Point point = from[i];
                // Written to both, advanced on one: the side is a coin toss, which a branch would mispredict. Neither
                // leaves the node's own range: left <= i, and right is at most half + 1 <= count elements in.
                const bool is_left = in_left[point.index];
                *left = *right = point;
                left += is_left, right += !is_left;
            }
            std::memcpy(from + half, &spare[first], half * sizeof(Point));
        }
        if (threads > 1) {
            std::thread other([&] { split(first, half, threads / 2); });
            split(first + half, half, threads - threads / 2);
            other.join();
        } else {
            split(first, half, 1);
            split(first + half, half, 1);
        }
    }
};

// Floats as integers of the same order; -0 and +0 differ, which is as good as any other order among equals.
uint32_t sortable(float v) {
    const uint32_t bits = std::bit_cast<uint32_t>(v);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

std::vector<Point> sorted(std::span<const glm::vec3> points, int axis, uint32_t threads) {
    std::vector<uint64_t> keys(points.size());
    std::vector<Point> order(points.size());
    engine::parallel_pieces(points.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) keys[i] = uint64_t(sortable(points[i][axis])) << 32 | i;
    }, threads);
    radix_sort(keys, [](uint64_t key) { return key; }, 32, 64, threads);  // stable: equals stay in the order of their indices
    engine::parallel_pieces(points.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) order[i] = {points[uint32_t(keys[i])], uint32_t(keys[i])};
    }, threads);
    return order;
}

}  // namespace

std::vector<uint32_t> bsh_order(std::span<const glm::vec3> points, uint32_t threads) {
    if (points.empty()) return {};
    assert(std::has_single_bit(points.size()) && points.size() <= uint64_t(1) << 31);
    if (threads == 0) threads = engine::host_threads();
    if (points.size() < 4096) threads = 1;

    Splitter splitter;
    for (int axis = 0; axis < 3; ++axis) splitter.order[axis] = sorted(points, axis, threads);
    splitter.spare.resize(points.size());
    splitter.in_left.resize(points.size());
    splitter.split(0, points.size(), threads);

    std::vector<uint32_t> order(points.size());
    for (size_t i = 0; i < points.size(); ++i) order[i] = splitter.order[0][i].index;
    return order;
}

}  // namespace myriad::compute
