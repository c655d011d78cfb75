// The plain CPU twin of the octree's contents, and what every such octree must satisfy.
#pragma once

#include <string>
#include <vector>

#include "compute/bsh/bsh_ref.hpp"
#include "compute/manylods/manylods_ref.hpp"
#include "compute/octree/octree_ref.hpp"
#include "compute/svo/svo.hpp"

namespace myriad::compute {

// An octree on the host: blocks, and the rest by node. All empty where there is nothing.
struct SvoArrays {
    uint depth = 0;
    std::vector<SvoBlock> blocks;
    std::vector<uvec2> spheres;
    std::vector<uint> cones;
    std::vector<uvec2> boxes;

    Sphere sphere(uint block, uint child) const { return bsh_decode(svo_frame(blocks[block]), spheres[blocks[block].first + child]); }
};

// What it is made of. `opacity`: of these triangles, one after the other.
struct SvoInput {
    std::vector<Corners> triangles;
    OctreeCube cube;
    uint depth;
    Opacity opacity = {};
};

SvoArrays svo_ref(const SvoInput& input);
SvoArrays svo_download(engine::Device& device, const Svo& svo);

// By slot, as twins of what walks and draws a hierarchy over samples take it.
HostTree svo_host_tree(const SvoArrays& svo);
BshArrays svo_slots(const SvoArrays& svo);

// The first violated invariant, or nothing: the leaves are the cells that triangles meet, and all nodes are reached, once; heights fall by one a level; of what
// triangles have in a leaf's cell, clipped in double, every corner is in its sphere and its box, and every normal in its cone; what is missing is that of the most
// whole triangle; nodes' spheres, cones and boxes hold their children's. All in double.
std::string svo_check(const SvoArrays& svo, const SvoInput& input);

}  // namespace myriad::compute
