// The plain CPU twin of the bottom-up pass, and the validator of trees that any test may call.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compute/bsh/bsh.hpp"

namespace myriad::compute {

// A hierarchy on the host; arrays as in BshRef.
struct BshArrays : BshShape {
    std::vector<vec4> frames;
    std::vector<uvec2> spheres;
    std::vector<uint> cones;
    std::vector<uvec2> boxes;

    Sphere sphere(uint slot) const { return bsh_decode(frames[slot >> arity_log2], spheres[slot]); }
};

// What the tree was made from.
struct BshInput {
    std::span<const SurfaceSample> samples;  // in leaf order
    std::span<const glm::vec3> positions;
    std::span<const glm::uvec4> triangles;
    float leaf_radius, leaf_share;
    Opacity opacity = {};                    // of the triangles

    vec3 position(uint leaf) const;
};

BshArrays bsh_ref(const BshInput& input, uint arity = bsh_arity_default);
BshArrays bsh_download(engine::Device& device, const Bsh& bsh);

// The first violated invariant, or nothing: sizes, the root alone in its slot, every leaf reached once from the root by
// index arithmetic, absent slots exactly where no node is, every leaf around its disc and every node around its children
// (spheres and cones). Nesting is judged in long double.
std::string bsh_check(const BshArrays& tree, const BshInput& input);

// The same for a leaf order: a permutation, and no node of the binary tree has a better median split than its own.
std::string bsh_check_order(std::span<const uint32_t> order, std::span<const glm::vec3> points);

}  // namespace myriad::compute
