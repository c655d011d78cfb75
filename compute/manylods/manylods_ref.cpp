#include "compute/manylods/manylods_ref.hpp"

#include <algorithm>
#include <ostream>

#include "engine/transfer.hpp"

namespace myriad::compute {

HostTree::HostTree(engine::Device& device, const Bsh& tree) : BshShape(tree.shape()) {
    if (tree.empty()) return;
    frames = engine::download(device, tree.frames());
    spheres = engine::download(device, tree.spheres());
    cones = engine::download(device, tree.cones());
}

void PrintTo(const NodeView& nv, std::ostream* out) {
    *out << "(slot " << nv.slot << ", view " << nv.view << (nv.culled ? ", culled)" : ", drawn)");
}

namespace {

void visit(const HostTree& tree, uint view_index, const View& view, uint slot, float epsilon, uint map_size, CutRef& out) {
    if (tree.absent(slot)) return;
    ++out.tested;
    switch (classify(view, tree.sphere(slot), bsh_height(slot, tree), epsilon, map_size)) {
        case node_view_culled: out.cut.push_back({view_index, slot, true}); break;
        case node_view_drawn: out.cut.push_back({view_index, slot, false}); break;
        default: {
            const uint block = bsh_block_of(slot, tree);
            for (uint i = 0; i < tree.arity(); ++i) visit(tree, view_index, view, tree.arity() * block + i, epsilon, map_size, out);
        }
    }
}

uint64_t count_leaves(const HostTree& tree, uint slot, std::vector<uint8_t>& covered) {
    if (tree.absent(slot)) return 0;
    if (bsh_is_leaf(slot, tree.leaves)) return ++covered[slot], 1;
    uint64_t count = 0;
    const uint block = bsh_block_of(slot, tree);
    for (uint i = 0; i < tree.arity(); ++i) count += count_leaves(tree, tree.arity() * block + i, covered);
    return count;
}

}  // namespace

CutRef cut_ref(const HostTree& tree, const std::vector<View>& views, float epsilon, uint map_size) {
    CutRef out;
    if (tree.leaves == 0) return out;
    for (uint v = 0; v < views.size(); ++v) visit(tree, v, views[v], tree.root(), epsilon, map_size, out);
    std::sort(out.cut.begin(), out.cut.end());
    return out;
}

std::vector<NodeView> node_views(const std::vector<uvec2>& groups, uint arity) {
    std::vector<NodeView> cut;
    for (const uvec2& code : groups) {
        const CutGroup g = cut_unpack(code);
        for (uint i = 0; i < bsh_most; ++i) {  // a bit beyond the arity would be another block's node, and be found out
            if (g.drawn >> i & 1) cut.push_back({g.view, arity * g.block + i, false});
            if (g.culled >> i & 1) cut.push_back({g.view, arity * g.block + i, true});
        }
    }
    std::sort(cut.begin(), cut.end());
    return cut;
}

std::string partition_violation(const HostTree& tree, const std::vector<NodeView>& cut, uint views) {
    size_t at = 0;
    std::vector<uint8_t> covered;
    for (uint v = 0; v < views; ++v) {
        covered.assign(tree.leaves, 0);
        for (; at < cut.size() && cut[at].view == v; ++at)
            if (count_leaves(tree, cut[at].slot, covered) == 0) return "view " + std::to_string(v) + ": slot " + std::to_string(cut[at].slot) + " holds nothing";
        for (uint leaf = 0; leaf < tree.leaves; ++leaf)
            if (covered[leaf] != 1)
                return "view " + std::to_string(v) + ": leaf " + std::to_string(leaf) + " is covered " + std::to_string(covered[leaf]) + " times";
    }
    return at == cut.size() ? "" : "a node-view of view " + std::to_string(cut[at].view) + ", which does not exist";
}

}  // namespace myriad::compute
