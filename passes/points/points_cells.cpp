#include "passes/points/points_cells.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "compute/bsh/bsh.hpp"
#include "engine/parallel.hpp"
#include "passes/points/points_io.h"

namespace myriad::passes {
namespace {

constexpr size_t grain = 1 << 12;

// The middles of nodes, level by level from the leaves, as of a tree of arity 8: which leaf a walk finds depends on the order alone.
std::vector<std::vector<vec3>> middles_of(const compute::WorldTriangles& world, std::span<const SurfaceSample> samples) {
    std::vector<std::vector<vec3>> levels;
    for (const compute::BshLevel& level : compute::bsh_levels(uint(samples.size()), bsh_most)) {
        std::vector<vec3> middles(level.nodes);
        engine::parallel_pieces(level.nodes, grain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                if (levels.empty()) {
                    const Corners c = world.corners(samples[i].triangle);
                    middles[i] = bsh_position(c.p0, c.p1, c.p2, samples[i].u, samples[i].v);
                    continue;
                }
                const std::vector<vec3>& below = levels.back();
                const size_t first = bsh_most * i, last = std::min(first + bsh_most, below.size());
                vec3 sum(0);
                for (size_t k = first; k < last; ++k) sum += below[k];
                middles[i] = sum / float(last - first);
            }
        });
        levels.push_back(std::move(middles));
    }
    return levels;
}

uint leaf_near(const std::vector<std::vector<vec3>>& levels, const vec3& at) {
    size_t node = 0;
    for (size_t level = levels.size() - 1; level-- > 0;) {
        const size_t first = bsh_most * node, last = std::min(first + bsh_most, levels[level].size());
        const auto away = [&](size_t k) {
            const vec3 d = levels[level][k] - at;
            return dot(d, d);
        };
        node = first;
        for (size_t k = first + 1; k < last; ++k)
            if (away(k) < away(node)) node = k;
    }
    return uint(node);
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
    const auto levels = middles_of(world, samples);
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
    if (getenv("POINTS_DEBUG")) {
        const float R = 1.75f * std::sqrt(share / 3.14159f);
        std::vector<float> far;
        for (const auto& piece : given)
            for (const Given& g : piece) {
                const Corners at = world.corners(g.cell.x);
                float f = 0;
                for (uint code : {g.cell.y, g.cell.z, g.cell.w}) { const vec2 uv = points_corner(code); f = std::max(f, glm::length(bsh_position(at.p0, at.p1, at.p2, uv.x, uv.y) - levels[0][g.leaf])); }
                far.push_back(f / R);
            }
        std::ranges::sort(far);
        for (double q : {0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999}) fprintf(stderr, "%g: %g\n", q, far[size_t(q * far.size())]);
        fprintf(stderr, "most %g, R %g, cells %zu\n", far.back(), R, far.size());
    }
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
