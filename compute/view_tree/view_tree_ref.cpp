#include "compute/view_tree/view_tree_ref.hpp"

#include <algorithm>
#include <numeric>

#include "compute/octree/octree.hpp"
#include "compute/view_tree/view_tree_merge.h"
#include "engine/transfer.hpp"

namespace myriad::compute {

namespace {

uint64_t wide(uvec2 key) { return uint64_t(key.y) << 32 | key.x; }

// [first, end) in the ranges of its children, as "view_tree/split" makes them.
std::vector<uvec2> split(const std::vector<uvec2>& keys, uint first, uint end) {
    std::vector<uvec2> ranges;
    const uvec2 low = keys[first], high = keys[end - 1];
    uint begin = first;
    for (uint i = 1; i <= view_tree_most; ++i) {
        uint at = end;
        if (low == high) at = first + uint(uint64_t(end - first) * i / view_tree_most);
        else if (i < view_tree_most)
            for (at = begin; at < end && view_key_octant(keys[at], octree_parting(low, high, view_tree_curve_bits)) < i;) ++at;
        if (at > begin) ranges.push_back({begin, at}), begin = at;
    }
    return ranges;
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

}  // namespace

HostViewTree view_tree_ref(const std::vector<View>& views, uint32_t capacity, vec3 low, vec3 high) {
    HostViewTree tree{.capacity = capacity};
    const uint32_t n = uint32_t(views.size());
    tree.order.resize(n);
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    std::vector<uvec2> keys(n), sorted;
    for (uint i = 0; i < n; ++i) keys[i] = view_key(views[i], octree_cube(low, high, view_tree_curve_bits));
    std::ranges::stable_sort(tree.order, {}, [&](uint i) { return wide(keys[i]); });
    for (uint i : tree.order) sorted.push_back(keys[i]), tree.nodes.push_back(views[i]);
    tree.nodes.resize(capacity);

    std::vector<uvec2> level;
    if (n > 0) level.push_back({0, n});
    while (!level.empty()) {
        const uint first = uint(capacity + tree.groups.size()), next = first + uint(level.size());
        tree.levels.push_back({first, uint(level.size())});
        std::vector<uvec2> below;
        for (const uvec2& range : level) {
            if (range.y - range.x <= view_tree_most) {
                tree.groups.push_back({0, range.x, range.y - range.x, range.x, range.y});
                continue;
            }
            const auto children = split(sorted, range.x, range.y);
            tree.groups.push_back({0, next + uint(below.size()), uint(children.size()), range.x, range.y});
            below.insert(below.end(), children.begin(), children.end());
        }
        level = below;
    }
    tree.nodes.resize(capacity + tree.groups.size());
    std::vector<ViewBox> boxes(tree.groups.size());
    for (size_t i = tree.groups.size(); i-- > 0;) {
        ViewGroup& group = tree.groups[i];
        ViewBox box = view_box_empty();
        vec3 sum(0);
        const auto each = [&](auto action) {
            for (uint child = group.first_child; child < group.first_child + group.children; ++child)
                if (!view_sees_nothing(tree.nodes[child])) action(child, tree.nodes[child]);
        };
        each([&](uint child, const View& view) {
            box = view_box_merge(box, tree.is_view(child) ? view_box_of(view) : boxes[child - capacity]);
            sum += view.direction;
        });
        View merged = view_of_nothing();
        if (box.low.x <= box.high.x) {
            merged.position = view_box_middle(box);
            float least = -1, reach = 0;
            merged.direction = vec3(1, 0, 0);
            if (dot(sum, sum) > 1e-6f) merged.direction = sum / sqrt(dot(sum, sum)), least = 1;
            each([&](uint child, const View& view) {
                least = std::min(least, view_cone_around(merged.direction, view));
                reach = std::max(reach, view_reach(merged.position, view.position, tree.radius(child)));
            });
            group.radius = std::min(view_box_radius(box), reach);
            merged.cos_phi = least, merged.sin_phi = sqrt(std::max(1 - least * least, 0.0f));
        }
        boxes[i] = box;
        tree.nodes[capacity + i] = merged;
    }
    return tree;
}

HostViewTree view_tree_download(engine::Device& device, const ViewTree& tree, uint32_t views) {
    HostViewTree host{.capacity = tree.capacity()};
    host.order = engine::download(device, tree.order(), views);
    const auto words = engine::download(device, tree.levels());
    uint inner = 0;
    for (uint level = 0; level < view_tree_levels && words[2 * level + 1] > 0; ++level) {
        host.levels.push_back({words[2 * level], words[2 * level + 1]});
        inner += words[2 * level + 1];
    }
    host.nodes = engine::download(device, tree.nodes(), tree.capacity() + inner);
    host.groups = engine::download(device, tree.groups(), inner);
    return host;
}

std::string view_tree_violation(const HostViewTree& tree, const std::vector<View>& views) {
    const auto at = [](uint node) { return "node " + std::to_string(node); };
    std::vector<uint> sorted = tree.order;
    std::ranges::sort(sorted);
    for (uint i = 0; i < views.size(); ++i)
        if (sorted.size() != views.size() || sorted[i] != i) return "the order is no permutation";
    if (tree.groups.empty()) return views.empty() ? "" : "there is no root";
    std::vector<uint> parents(tree.nodes.size());
    for (uint i = 0; i < tree.groups.size(); ++i) {
        const uint node = tree.capacity + i;
        const ViewGroup& group = tree.groups[i];
        if (group.children == 0 || group.children > view_tree_most) return at(node) + " has " + std::to_string(group.children) + " children";
        if (!tree.is_view(group.first_child) && group.children < 2) return at(node) + " is a link of a chain";
        uint expected = group.first;
        for (uint child = group.first_child; child < group.first_child + group.children; ++child) {
            if (child >= tree.nodes.size()) return at(node) + " has a child that is none";
            if (parents[child]++ > 0) return at(child) + " has two parents";
            const uint first = tree.is_view(child) ? child : tree.group(child).first, end = tree.is_view(child) ? child + 1 : tree.group(child).end;
            if (first != expected || end <= first) return at(node) + "'s children do not follow one another";
            expected = end;
        }
        if (expected != group.end) return at(node) + "'s children end elsewhere";
        const View& bound = tree.nodes[node];
        double farthest = 0;
        for (uint v = group.first; v < group.end; ++v) {
            const View& view = views[tree.order[v]];
            if (view_sees_nothing(view)) continue;
            farthest = std::max(farthest, glm::length(glm::dvec3(view.position) - glm::dvec3(bound.position)));
            if (bound.cos_phi <= -1) continue;
            const double psi = std::atan2(double(bound.sin_phi), double(bound.cos_phi)), phi = std::atan2(double(view.sin_phi), double(view.cos_phi));
            if (angle_between(bound.direction, view.direction) + phi > psi + 1e-7) return at(node) + "'s cone does not hold the frustum of a view";
        }
        if (farthest > double(group.radius)) return at(node) + "'s sphere does not hold a view";
        if (group.radius > 0 && farthest == 0) return at(node) + " is one place, and has a radius";
    }
    for (uint i = 0; i < views.size(); ++i) {
        if (parents[i] != 1) return at(i) + ", a view, is in no leaf";
        const View &a = tree.nodes[i], &b = views[tree.order[i]];
        if (std::memcmp(&a, &b, sizeof a) != 0) return at(i) + " is another view than the order says";
    }
    if (tree.group(tree.capacity).first != 0 || tree.group(tree.capacity).end != views.size()) return "the root does not hold all views";
    return "";
}

}  // namespace myriad::compute
