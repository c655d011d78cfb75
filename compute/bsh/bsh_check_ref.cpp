// The validator: it walks as a kernel would, and trusts nothing of how the tree was built.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "compute/bsh/bsh_ref.hpp"

namespace myriad::compute {
namespace {

using Real = long double;
using RealVec = glm::vec<3, Real>;

Real length_of(RealVec v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

bool contains(const Sphere& outer, const Sphere& inner) {
    const Real reach = length_of(RealVec(outer.center) - RealVec(inner.center)) + Real(inner.radius);
    // Exact where the centres coincide; elsewhere long double is 2^40 times finer than the margin that was added.
    return reach <= Real(outer.radius);
}

// A cone of lines with its half-angle in radians.
struct Lines {
    RealVec axis;
    Real angle;
};
Lines lines(uint cone) {
    const RealVec axis(bsh_cone_axis(cone));
    const Real t = Real(cone >> 24) / 255;
    return {axis / length_of(axis), std::acos(1 - t * t)};
}
bool contains(const Lines& outer, const Lines& inner) {
    if (outer.angle >= std::acos(Real(0))) return true;
    const Real between = std::atan2(length_of(glm::cross(outer.axis, inner.axis)), std::abs(glm::dot(outer.axis, inner.axis)));
    return between + inner.angle <= outer.angle + Real(1e-12);
}

bool contains(const Sphere& s, const BshBox& decoded, const BshBox& exact) {
    for (int axis = 0; axis < 3; ++axis) {
        const Real center = s.center[axis];
        // The code's corners are of single precision: their own error, and that of the sum with the centre.
        const Real error = (Real(s.radius) + std::abs(center)) * Real(1e-6);
        if (center + Real(decoded.low[axis]) > Real(exact.low[axis]) + error || center + Real(decoded.high[axis]) < Real(exact.high[axis]) - error)
            return false;
    }
    return true;
}

struct Walk {
    const BshArrays& tree;
    const BshInput& input;
    std::vector<bool> reached;  // by slot
    std::string fault;

    bool fail(uint slot, const char* what) {
        if (fault.empty()) fault = "slot " + std::to_string(slot) + ": " + what;
        return false;
    }

    bool leaf(uint slot) {
        if (!contains(tree.sphere(slot), {input.position(slot), input.leaf_radius}))
            return fail(slot, "the leaf's sphere does not contain its disc");
        const SurfaceSample& s = input.samples[slot];
        if (bsh_missing(tree.boxes[slot]) != input.opacity.missing({s.triangle}, s.u, s.v)) return fail(slot, "is not as whole as the surface");
        const glm::uvec4 t = input.triangles[s.triangle];
        const RealVec a(input.positions[t.x]), b(input.positions[t.y]), c(input.positions[t.z]);
        const RealVec normal = glm::cross(b - a, c - a);
        const Real length = length_of(normal);
        const Lines cone = lines(tree.cones[slot]);
        if (!(length > 0)) return tree.cones[slot] >> 24 == 255 || fail(slot, "a normal that does not exist has a cone");
        return contains(cone, {normal / length, 0}) || fail(slot, "the leaf's cone does not contain its normal");
    }

    // Around the patches of the samples below a node.
    BshBox reach(uint slot) const {
        if (bsh_is_leaf(slot, tree.leaves)) {
            const glm::uvec4 t = input.triangles[input.samples[slot].triangle];
            return bsh_patch_box(input.position(slot), input.positions[t.x], input.positions[t.y], input.positions[t.z], tree.cones[slot],
                                 input.leaf_radius, input.leaf_share);
        }
        BshBox box{vec3(HUGE_VALF), vec3(-HUGE_VALF)};
        const uint block = bsh_block_of(slot, tree);
        for (uint child = tree.arity() * block; child < tree.arity() * (block + 1); ++child) {
            if (bsh_is_absent(tree.spheres[child])) continue;
            const BshBox part = reach(child);
            box.low = glm::min(box.low, part.low);
            box.high = glm::max(box.high, part.high);
        }
        return box;
    }

    bool node(uint slot) {
        if (slot >= tree.spheres.size()) return fail(slot, "outside the arrays");
        if (reached[slot]) return fail(slot, "reached twice");
        reached[slot] = true;
        if (bsh_is_absent(tree.spheres[slot])) return fail(slot, "absent, but a node of the tree");
        const Sphere sphere = tree.sphere(slot);
        if (!std::isfinite(sphere.radius) || !std::isfinite(length_of(RealVec(sphere.center)))) return fail(slot, "the sphere is not finite");
        if (!contains(sphere, bsh_decode_box(tree.boxes[slot], sphere.radius), reach(slot)))
            return fail(slot, "the box does not contain the patches below");
        if (bsh_is_leaf(slot, tree.leaves)) return leaf(slot);
        const uint block = bsh_block_of(slot, tree);
        if (block >= tree.blocks) return fail(slot, "owns a block outside the tree");
        uint children = 0, missing = opacity_nothing;
        for (uint child = tree.arity() * block; child < tree.arity() * (block + 1); ++child) {
            if (bsh_is_absent(tree.spheres[child])) continue;
            ++children;
            missing = std::min(missing, bsh_missing(tree.boxes[child]));
            if (!node(child)) return false;
            if (!contains(sphere, tree.sphere(child))) return fail(child, "the parent's sphere does not contain the child's");
            if (!contains(lines(tree.cones[slot]), lines(tree.cones[child])))
                return fail(child, "the parent's cone does not contain the child's");
        }
        if (missing != bsh_missing(tree.boxes[slot])) return fail(slot, "is not as whole as the most whole child");
        if (children != tree.arity() && slot != tree.root()) return fail(slot, "has fewer children than the arity");
        return children > 0 || fail(slot, "has no children");
    }
};

}  // namespace

std::string bsh_check(const BshArrays& tree, const BshInput& input) {
    const size_t slots = tree.arity() * (size_t(tree.blocks) + 1);
    if (tree.leaves != input.samples.size()) return "as many leaves as samples expected";
    if (tree.frames.size() != slots / tree.arity() || tree.spheres.size() != slots || tree.cones.size() != slots || tree.boxes.size() != slots)
        return "array sizes do not fit the block count";
    Walk walk{tree, input, std::vector<bool>(slots), {}};
    walk.node(tree.root());
    if (!walk.fault.empty()) return walk.fault;
    for (uint slot = 0; slot < slots; ++slot)
        if (walk.reached[slot] == bsh_is_absent(tree.spheres[slot])) return "slot " + std::to_string(slot) + ": not reached, but present";
    for (uint leaf = 0; leaf < tree.leaves; ++leaf)
        if (!walk.reached[leaf]) return "slot " + std::to_string(leaf) + ": a leaf that is not reached";
    return {};
}

std::string bsh_check_order(std::span<const uint32_t> order, std::span<const glm::vec3> points) {
    std::vector<uint32_t> seen(order.begin(), order.end()), expected(points.size());
    std::sort(seen.begin(), seen.end());
    std::iota(expected.begin(), expected.end(), 0u);
    if (seen != expected) return "not a permutation";
    auto volume = [&](std::span<const uint32_t> part) {
        RealVec low(points[part[0]]), high(low);
        for (uint32_t i : part) low = glm::min(low, RealVec(points[i])), high = glm::max(high, RealVec(points[i]));
        return std::pow(length_of(high - low), Real(3));
    };
    for (size_t count = order.size(); count > 1; count /= 2)
        for (size_t first = 0; first < order.size(); first += count) {
            const auto node = order.subspan(first, count);
            const Real actual = volume(node.first(count / 2)) + volume(node.last(count / 2));
            Real least = HUGE_VALL;
            std::vector<uint32_t> sorted(node.begin(), node.end());
            for (int axis = 0; axis < 3; ++axis) {
                std::sort(sorted.begin(), sorted.end(), [&](uint32_t a, uint32_t b) {
                    return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
                });
                const std::span<const uint32_t> halves(sorted);
                least = std::min(least, volume(halves.first(count / 2)) + volume(halves.last(count / 2)));
            }
            if (actual > least * (1 + Real(1e-9)))
                return "points " + std::to_string(first) + " + " + std::to_string(count) + ": another median is better";
        }
    return {};
}

}  // namespace myriad::compute
