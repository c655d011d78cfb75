#include "compute/bsh/bsh_ref.hpp"

#include <algorithm>
#include <cmath>

#include "engine/transfer.hpp"

namespace myriad::compute {

using glm::dvec3;

vec3 BshInput::position(uint leaf) const {
    const SurfaceSample& s = samples[leaf];
    const glm::uvec4 t = triangles[s.triangle];
    return bsh_position(positions[t.x], positions[t.y], positions[t.z], s.u, s.v);
}

BshArrays bsh_ref(const BshInput& input, uint arity) {
    const std::vector<BshLevel> levels = bsh_levels(uint(input.samples.size()), arity);
    BshArrays tree;
    tree.leaves = levels.front().nodes;
    tree.blocks = levels.back().first_block();
    tree.arity_log2 = levels.front().arity_log2;
    tree.frames.resize(tree.blocks + 1);
    tree.spheres.resize(arity * (tree.blocks + 1));
    tree.cones.resize(arity * (tree.blocks + 1));
    tree.boxes.resize(arity * (tree.blocks + 1));

    std::vector<Sphere> nodes(tree.leaves);  // of the level, before they are encoded
    std::vector<BshBox> reaches(tree.leaves);
    std::vector<uint> missing(tree.leaves);
    for (uint leaf = 0; leaf < tree.leaves; ++leaf) {
        const glm::uvec4 t = input.triangles[input.samples[leaf].triangle];
        nodes[leaf] = {input.position(leaf), input.leaf_radius};
        tree.cones[leaf] = bsh_cone_of(input.positions[t.y] - input.positions[t.x], input.positions[t.z] - input.positions[t.x]);
        reaches[leaf] = bsh_patch_box(nodes[leaf].center, input.positions[t.x], input.positions[t.y], input.positions[t.z], tree.cones[leaf],
                                      input.leaf_radius, input.leaf_share);
        const SurfaceSample& s = input.samples[leaf];
        missing[leaf] = input.opacity.missing({s.triangle}, s.u, s.v);
    }
    for (const BshLevel& level : levels) {
        std::vector<Sphere> owners;
        std::vector<BshBox> owner_reaches;
        std::vector<uint> owner_missing;
        for (uint block = 0; block < level.blocks(); ++block) {
            const uint slot = level.first_slot + arity * block;
            BshSpheres spheres;
            BshCones cones;
            BshBoxes boxes;
            for (uint i = 0; i < bsh_most; ++i) {
                const uint node = std::min(arity * block + std::min(i, arity - 1), level.nodes - 1);
                spheres.at[i] = nodes[node];
                cones.at[i] = tree.cones[level.first_slot + node];
                boxes.at[i] = reaches[node];
                boxes.missing[i] = missing[node];
            }
            const vec4 frame = tree.frames[slot / arity] = bsh_frame(spheres);
            for (uint i = 0; i < bsh_most; ++i) {
                const uvec2 code = bsh_encode(frame, spheres.at[i]);
                spheres.at[i] = bsh_decode(frame, code);
                if (i >= arity) continue;
                const bool present = arity * block + i < level.nodes;
                tree.spheres[slot + i] = present ? code : uvec2(0, bsh_absent << 16);
                tree.boxes[slot + i] = present ? bsh_encode_box(spheres.at[i], boxes.at[i], boxes.missing[i]) : uvec2(0);
                if (!present) tree.cones[slot + i] = bsh_cone_all;
            }
            if (slot == tree.root()) break;
            owners.push_back(bsh_merge(spheres));
            owner_reaches.push_back(bsh_merge_boxes(boxes));
            owner_missing.push_back(bsh_merge_missing(boxes));
            tree.cones[level.first_slot + arity * level.blocks() + block] = bsh_cone_merge(cones);
        }
        nodes = std::move(owners);
        reaches = std::move(owner_reaches);
        missing = std::move(owner_missing);
    }
    return tree;
}

BshArrays bsh_download(engine::Device& device, const Bsh& bsh) {
    return {bsh.shape(), engine::download(device, bsh.frames()), engine::download(device, bsh.spheres()), engine::download(device, bsh.cones()),
            engine::download(device, bsh.boxes())};
}

}  // namespace myriad::compute
