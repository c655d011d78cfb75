#include "passes/fuse/fuse_ref.hpp"

#include <functional>

namespace myriad::passes {

std::vector<uint> fuse_ref(const compute::HostViewTree& tree, std::vector<uint> maps, const std::vector<bool>& has_map, uint map_size) {
    const uint texels = map_texels(map_size);
    const std::function<void(uint, uint)> visit = [&](uint node, uint above) {
        const bool own = tree.is_view(node) || has_map[node];
        if (own && above != fuse_no_map && !view_sees_nothing(tree.nodes[node])) {
            const vec3 offset = tree.nodes[node].position - tree.nodes[above].position;
            for (uint half = 0; half < 2; ++half)
                for (uint y = 0; y < map_size; ++y)
                    for (uint x = 0; x < map_size; ++x) {
                        const uint texel = texel_index(half, x, y, map_size), depth = maps[size_t(above) * texels + texel];
                        if (depth == atlas_nothing) continue;
                        const float t = fused_depth(offset, unproject(half, texel_middle(x, y, map_size)), uintBitsToFloat(depth));
                        uint& to = maps[size_t(node) * texels + texel];
                        to = std::min(to, floatBitsToUint(t));
                    }
        }
        if (tree.is_view(node)) return;
        const ViewGroup& group = tree.group(node);
        for (uint child = group.first_child; child < group.first_child + group.children; ++child) visit(child, own ? node : above);
    };
    if (!tree.groups.empty()) visit(tree.capacity, fuse_no_map);
    maps.resize(size_t(tree.views()) * texels);
    return maps;
}

}  // namespace myriad::passes
