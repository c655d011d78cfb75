#include "passes/points/points_cells.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>

#include "compute/bsh/bsh.hpp"
#include "engine/parallel.hpp"
#include "passes/points/points_io.h"

namespace myriad::passes {
namespace {

constexpr size_t grain = 1 << 12;

// Boxes around nodes' samples, level by level from the leaves, as of a tree of arity 8: what is nearest does not depend on that.
struct Box {
    vec3 low, high;

    float away2(const vec3& at) const {
        const vec3 d = max(max(low - at, at - high), vec3(0));
        return dot(d, d);
    }
};
using Levels = std::vector<std::vector<Box>>;
Levels boxes_of(const compute::WorldTriangles& world, std::span<const SurfaceSample> samples) {
    Levels levels;
    for (const compute::BshLevel& level : compute::bsh_levels(uint(samples.size()), bsh_most)) {
        std::vector<Box> boxes(level.nodes);
        engine::parallel_pieces(level.nodes, grain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                if (levels.empty()) {
                    const Corners c = world.corners(samples[i].triangle);
                    const vec3 at = bsh_position(c.p0, c.p1, c.p2, samples[i].u, samples[i].v);
                    boxes[i] = {at, at};
                    continue;
                }
                const std::vector<Box>& below = levels.back();
                boxes[i] = below[bsh_most * i];
                for (size_t k = bsh_most * i; k < std::min(bsh_most * (i + 1), below.size()); ++k)
                    boxes[i] = {min(boxes[i].low, below[k].low), max(boxes[i].high, below[k].high)};
            }
        });
        levels.push_back(std::move(boxes));
    }
    return levels;
}

struct Nearest {
    float away2 = std::numeric_limits<float>::infinity();
    uint leaf = 0;
};
// The leaf nearest to `at` below a node, where it is nearer than what was found; nearer children first.
void find_nearest(const Levels& levels, size_t level, size_t node, const vec3& at, Nearest& nearest) {
    const std::vector<Box>& below = levels[level - 1];
    const size_t first = bsh_most * node, count = std::min<size_t>(bsh_most, below.size() - first);
    std::array<float, bsh_most> away2;
    for (size_t k = 0; k < count; ++k) away2[k] = below[first + k].away2(at);
    for (size_t left = count; left > 0; --left) {
        size_t next = 0;
        for (size_t k = 1; k < count; ++k)
            if (away2[k] < away2[next]) next = k;
        if (!(away2[next] < nearest.away2)) return;
        if (level == 1) nearest = {away2[next], uint(first + next)};
        else find_nearest(levels, level - 1, first + next, at, nearest);
        away2[next] = std::numeric_limits<float>::infinity();
    }
}
uint leaf_near(const Levels& levels, const vec3& at) {
    Nearest nearest;
    if (levels.size() > 1) find_nearest(levels, levels.size() - 1, 0, at, nearest);
    return nearest.leaf;
}

struct Part {
    std::array<uvec2, 3> corners;  // in barycentrics, in units of 1 / points_cell_steps
};

// Halves what is larger than `largest`, across the longest edge. visit(part, its middle).
template <class Visit>
void cut(const Corners& c, const Part& part, double area, double largest, Visit& visit) {
    std::array<vec3, 3> at;
    for (int i = 0; i < 3; ++i) {
        const vec2 uv = vec2(part.corners[size_t(i)]) / float(points_cell_steps);
        at[size_t(i)] = bsh_position(c.p0, c.p1, c.p2, uv.x, uv.y);
    }
    const auto edge = [&](size_t i) {
        const vec3 d = at[(i + 1) % 3] - at[i];
        return dot(d, d);
    };
    const size_t longest = edge(0) >= edge(1) ? (edge(0) >= edge(2) ? 0 : 2) : edge(1) >= edge(2) ? 1 : 2;
    const uvec2 from = part.corners[longest], to = part.corners[(longest + 1) % 3], apex = part.corners[(longest + 2) % 3], sum = from + to;
    if (!(area > largest) || (sum.x & 1) || (sum.y & 1)) return visit(part, (at[0] + at[1] + at[2]) / 3.0f);
    cut(c, {{from, sum / 2u, apex}}, 0.5 * area, largest, visit);
    cut(c, {{sum / 2u, to, apex}}, 0.5 * area, largest, visit);
}

uint pack(const uvec2& corner) { return corner.x | corner.y << 16; }

}  // namespace

PointsCells points_cells(const compute::WorldTriangles& world, std::span<const SurfaceSample> samples, float share) {
    const Levels levels = boxes_of(world, samples);
    struct Given {
        uint leaf;
        uvec4 cell;
    };
    std::vector<std::vector<Given>> given((world.count() + grain - 1) / grain);
    engine::parallel_pieces(world.count(), grain, [&](size_t begin, size_t end) {
        std::vector<Given>& here = given[begin / grain];
        world.for_each(uint32_t(begin), uint32_t(end), [&](uint32_t id, uint32_t stored, const Corners& c) {
            const double area = 0.5 * glm::length(glm::cross(glm::dvec3(c.p1) - glm::dvec3(c.p0), glm::dvec3(c.p2) - glm::dvec3(c.p0)));
            if (!(area > 0) || !std::isfinite(area)) return;  // rays do not see it
            if (!world.opacity.everywhere() && world.opacity.kind(stored) == compute::Opacity::Kind::nowhere) return;
            auto visit = [&](const Part& part, const vec3& middle) {
                here.push_back({leaf_near(levels, middle), uvec4(id, pack(part.corners[0]), pack(part.corners[1]), pack(part.corners[2]))});
            };
            cut(c, {{uvec2(0), uvec2(points_cell_steps, 0), uvec2(0, points_cell_steps)}}, area, 2 * double(share), visit);
        });
    });
    PointsCells out;
    out.first.assign(samples.size() + 1, 0);
    for (const auto& piece : given)
        for (const Given& g : piece) ++out.first[g.leaf + 1];
    std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
    out.cells.resize(out.first.back());
    std::vector<uint> at(out.first.begin(), out.first.end() - 1);
    for (const auto& piece : given)
        for (const Given& g : piece) out.cells[at[g.leaf]++] = g.cell;
    return out;
}

PointsCells points_reorder(const PointsCells& from, std::span<const SurfaceSample> before, std::span<const SurfaceSample> now) {
    assert(before.size() == now.size());
    const auto sorted = [](std::span<const SurfaceSample> samples) {
        std::vector<uint> order(samples.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::sort(order, {}, [&](uint i) { return std::tuple(samples[i].triangle, floatBitsToUint(samples[i].u), floatBitsToUint(samples[i].v), i); });
        return order;
    };
    const std::vector<uint> old_order = sorted(before), new_order = sorted(now);
    std::vector<uint> was(now.size());
    for (size_t i = 0; i < now.size(); ++i) was[new_order[i]] = old_order[i];
    PointsCells out;
    out.first = {0};
    for (const uint leaf : was) {
        out.cells.insert(out.cells.end(), from.cells.begin() + from.first[leaf], from.cells.begin() + from.first[leaf + 1]);
        out.first.push_back(uint(out.cells.size()));
    }
    return out;
}

}  // namespace myriad::passes
