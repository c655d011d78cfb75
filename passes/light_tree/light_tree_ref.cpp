#include "passes/light_tree/light_tree_ref.hpp"

#include <cmath>

namespace myriad::passes {

std::vector<View> light_views(const std::vector<Vpl>& lights) {
    std::vector<View> views;
    for (const Vpl& light : lights)
        views.push_back(light.position.x >= 1e14f ? view_of_nothing() : View{light.position, 0, unpack_direction(light.normal), 1});
    return views;
}

HostLightTree light_tree_ref(const std::vector<Vpl>& lights, uint32_t capacity, vec3 low, vec3 high) {
    HostLightTree tree{.views = compute::view_tree_ref(light_views(lights), capacity, low, high), .lights = {}, .nodes = {}};
    tree.nodes.resize(tree.views.nodes.size());
    for (uint i = 0; i < lights.size(); ++i) {
        tree.lights.push_back(lights[tree.views.order[i]]);
        tree.nodes[i] = light_leaf(tree.lights[i]);
    }
    for (size_t i = tree.views.groups.size(); i-- > 0;) {
        const ViewGroup& group = tree.views.groups[i];
        float flux = 0;
        for (uint c = 0; c < group.children; ++c) flux += tree.nodes[group.first_child + c].flux;
        tree.nodes[capacity + i] = light_inner(tree.views.nodes[capacity + i], group.radius, flux, group.first_child, group.children);
    }
    return tree;
}

std::string light_tree_violation(const HostLightTree& tree) {
    for (size_t i = 0; i < tree.views.groups.size(); ++i) {
        const std::string at = "node " + std::to_string(tree.views.capacity + i);
        const ViewGroup& group = tree.views.groups[i];
        const LightNode& node = tree.nodes[tree.views.capacity + i];
        double flux = 0;
        for (uint v = group.first; v < group.end; ++v) {
            const Vpl& light = tree.lights[v];
            flux += double(light.flux.x) + double(light.flux.y) + double(light.flux.z);
            if (light_flux(light.flux) == 0) continue;
            if (glm::length(glm::dvec3(light.position) - glm::dvec3(node.position)) > double(node.radius) * (1 + 1e-6) + 1e-12) return at + "'s sphere does not hold a light";
            const glm::dvec3 axis(unpack_direction(node.axis)), normal(unpack_direction(light.normal));
            const double angle = std::atan2(glm::length(glm::cross(axis, normal)), glm::dot(axis, normal));
            if (node.cos_spread > -1 && angle > std::acos(std::min(double(node.cos_spread), 1.0)) + 2e-4) return at + "'s cone does not hold a normal";
        }
        if (std::abs(flux - double(node.flux)) > 1e-5 * flux) return at + "'s flux is not that of the lights below";
        if (light_first_child(node) != group.first_child || light_child_count(node) != group.children) return at + " has other children than the tree of views";
    }
    return "";
}

}  // namespace myriad::passes
