#include "passes/brute/brute_ref.hpp"

namespace myriad::passes {

std::vector<uint> brute_ref(const compute::WorldTriangles& world, std::span<const View> views, uint first, uint maps, uint map_size) {
    std::vector<uint> atlas(size_t(maps) * map_texels(map_size), atlas_nothing);
    world.for_each([&](uint32_t id, uint32_t, const Corners& p) {
        const Sphere sphere = brute_sphere(p);
        for (uint v = first; v < first + maps && v < views.size(); ++v) {
            const BruteTriangle t = brute_around(views[v].position, p);
            if (brute_outside(views[v], t, sphere)) continue;
            const BruteEdges e = brute_edges(p, t);
            for (uint half : {half_front, half_back})
                for (uint y = 0; y < map_size; ++y)
                    for (uint x = 0; x < map_size; ++x) {
                        const BruteHit hit = brute_hit(t, e, half, texel_middle(x, y, map_size), map_size);
                        if (!(hit.depth > 0)) continue;
                        if (!world.opacity.everywhere() && !opacity_in_view(world.opacity.missing(world.place(id), hit.u, hit.v), v)) continue;
                        uint& texel = atlas[size_t(v - first) * map_texels(map_size) + texel_index(half, x, y, map_size)];
                        texel = min(texel, floatBitsToUint(hit.depth));
                    }
        }
    });
    return atlas;
}

}  // namespace myriad::passes
