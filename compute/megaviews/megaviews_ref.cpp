#include "compute/megaviews/megaviews_ref.hpp"

#include <algorithm>
#include <ostream>

namespace myriad::compute {

namespace {

struct Walk {
    const HostTree& tree;
    const HostViewTree& views;
    uint first, end;
    float epsilon;
    uint map_size;
    PairsRef& out;

    uint wanted(uint node) const {
        const uint low = std::max(first, views.is_view(node) ? node : views.group(node).first);
        const uint high = std::min(end, views.is_view(node) ? node + 1 : views.group(node).end);
        return high > low ? high - low : 0;
    }
    void visit(uint slot, uint node) {
        if (tree.absent(slot) || wanted(node) == 0) return;
        ++out.tested;
        const Sphere sphere = tree.sphere(slot);
        const bool leaf = tree.is_leaf(slot);
        const float radius = views.radius(node);
        const uint where = classify_pair(views.nodes[node], radius, sphere, leaf, tree.height(slot), epsilon, map_size);
        if (where != pair_open) {
            const bool edge_on = where == pair_drawn && slot != tree.root() && pair_edge_on(views.nodes[node], sphere, tree.cones[slot]);
            out.pairs.push_back({node, slot, where == pair_culled, edge_on});
            if (where == pair_drawn && !edge_on) out.shared += wanted(node);
        } else if (pair_splits_views(radius, sphere.radius, leaf)) {
            const ViewGroup& group = views.group(node);
            for (uint child = group.first_child; child < group.first_child + group.children; ++child) visit(slot, child);
        } else {
            const uint block = tree.block_of(slot);
            for (uint i = 0; i < tree.arity(); ++i) visit(tree.arity() * block + i, node);
        }
    }
};

// Leaves below a slot.
void each_leaf(const HostTree& tree, uint slot, const auto& action) {
    if (tree.absent(slot)) return;
    if (tree.is_leaf(slot)) return action(slot);
    for (uint i = 0; i < tree.arity(); ++i) each_leaf(tree, tree.arity() * tree.block_of(slot) + i, action);
}

// Whether any point of the sphere is within the view's frustum, for sure: in doubles, and clear of what floats may have rounded.
bool surely_sees(const View& view, const Sphere& sphere) {
    const glm::dvec3 d = glm::dvec3(sphere.center) - glm::dvec3(view.position), n = view.direction;
    const double along = glm::dot(d, n), across = glm::length(d - along * n);
    double distance = across * double(view.cos_phi) - along * double(view.sin_phi);
    if (view.cos_phi > 0 && along * double(view.cos_phi) + across * double(view.sin_phi) < 0) distance = glm::length(d);
    return distance < double(sphere.radius);
}

}  // namespace

void PrintTo(const TerminalPair& pair, std::ostream* out) { *out << "(node " << pair.node << ", slot " << pair.slot << (pair.culled ? ", culled)" : ")"); }

PairsRef pairs_ref(const HostTree& tree, const HostViewTree& views, uint first, uint end, float epsilon, uint map_size) {
    PairsRef out;
    if (!tree.spheres.empty() && !views.groups.empty()) Walk{tree, views, first, end, epsilon, map_size, out}.visit(tree.root(), views.capacity);
    std::ranges::sort(out.pairs);
    return out;
}

std::vector<TerminalPair> rendered_pairs(const std::vector<uvec2>& groups, uint arity) {
    std::vector<TerminalPair> pairs;
    for (const uvec2& code : groups) {
        const CutGroup g = cut_unpack(code);
        for (uint i = 0; i < 8; ++i)
            if (g.drawn >> i & 1) pairs.push_back({g.view, arity * g.block + i, false});
    }
    std::ranges::sort(pairs);
    return pairs;
}

std::string pairs_violation(const HostTree& tree, const HostViewTree& views, uint first, uint end, const std::vector<TerminalPair>& pairs) {
    std::vector<uint> times(size_t(tree.leaves) * views.views());
    std::string wrong;
    for (const TerminalPair& pair : pairs) {
        const uint low = std::max(first, views.is_view(pair.node) ? pair.node : views.group(pair.node).first);
        const uint high = std::min(end, views.is_view(pair.node) ? pair.node + 1 : views.group(pair.node).end);
        if (low >= high) return "a pair is of no view that is wanted";
        each_leaf(tree, pair.slot, [&](uint leaf) {
            for (uint view = low; view < high; ++view) {
                ++times[size_t(leaf) * views.views() + view];
                if (pair.culled && wrong.empty() && surely_sees(views.nodes[view], tree.sphere(leaf)))
                    wrong = "leaf " + std::to_string(leaf) + " is culled for view " + std::to_string(view) + ", which sees it";
            }
        });
    }
    if (!wrong.empty()) return wrong;
    for (uint leaf = 0; leaf < tree.leaves; ++leaf) {
        if (tree.absent(leaf) || !tree.is_leaf(leaf)) continue;
        for (uint view = first; view < std::min(end, views.views()); ++view)
            if (const uint n = times[size_t(leaf) * views.views() + view]; n != 1)
                return "leaf " + std::to_string(leaf) + " and view " + std::to_string(view) + " are below " + std::to_string(n) + " pairs";
    }
    return "";
}

}  // namespace myriad::compute
