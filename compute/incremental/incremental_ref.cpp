#include "compute/incremental/incremental_ref.hpp"

#include <algorithm>

namespace myriad::compute {

namespace {

uint where(const HostTree& tree, const View& view, uint slot, float epsilon, uint map_size) {
    return classify(view, tree.sphere(slot), bsh_height(slot, tree), epsilon, map_size);
}

template <class Visit>
void for_children(const HostTree& tree, uint slot, Visit visit) {
    const uint block = bsh_block_of(slot, tree);
    for (uint child = tree.arity() * block; child < tree.arity() * (block + 1); ++child)
        if (!tree.absent(child)) visit(child);
}

}  // namespace

void CarriedCutRef::update(const HostTree& tree, const std::vector<View>& views, uint32_t most, float epsilon, uint map_size, uint32_t edges) {
    invalid_ = 0;
    if (tree.leaves == 0) return;
    if (open_.empty()) edges = 0;
    open_.resize(most);
    for (uint v = 0; v < most; ++v) {
        std::set<uint>& open = open_[v];
        if (v >= views.size()) {
            open.clear();
            continue;
        }
        const auto is_open = [&](uint slot) { return where(tree, views[v], slot, epsilon, map_size) == node_view_open; };
        std::erase_if(open, [&](uint slot) { return !is_open(slot); });
        std::vector<uint> opened, next;
        if (!open.contains(tree.root()) && is_open(tree.root())) opened.push_back(tree.root());
        for (uint slot : open)
            for_children(tree, slot, [&](uint child) { if (!open.contains(child) && is_open(child)) opened.push_back(child); });
        for (uint edge = 1; !opened.empty(); ++edge, opened.swap(next)) {
            open.insert(opened.begin(), opened.end());
            next.clear();
            for (uint slot : opened)
                for_children(tree, slot, [&](uint child) { if (is_open(child)) next.push_back(child); });
            if (edge != edges) continue;
            invalid_ += next.size();
            next.clear();
        }
    }
}

std::vector<NodeView> CarriedCutRef::cut(const HostTree& tree, const std::vector<View>& views, float epsilon, uint map_size) const {
    std::vector<NodeView> cut;
    if (tree.leaves == 0) return cut;
    for (uint v = 0; v < views.size(); ++v) {
        const auto keep = [&](uint slot) {
            if (!open_[v].contains(slot)) cut.push_back({v, slot, where(tree, views[v], slot, epsilon, map_size) == node_view_culled});
        };
        keep(tree.root());
        for (uint slot : open_[v]) for_children(tree, slot, keep);
    }
    std::sort(cut.begin(), cut.end());
    return cut;
}

}  // namespace myriad::compute
