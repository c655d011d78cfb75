#include "passes/splat/splat_ref.hpp"

namespace myriad::passes {
namespace {

bool within(uint x, float middle, float radius, uint size) {
    return splat_first(middle - radius, size) <= x && x < splat_end(middle + radius, size);
}

void draw(const Splat& s, uint size, uint* map) {
    for (uint half : {half_front, half_back}) {
        if (half != half_of(s.d) && !splat_in_both(s.d, s.radius, size)) continue;
        const Footprint f = footprint(half, s.d, s.radius);
        for (uint y = 0; y < size; ++y)
            for (uint x = 0; x < size; ++x) {
                if (!within(x, f.center.x, f.radius, size) || !within(y, f.center.y, f.radius, size)) continue;
                const float depth = splat_depth(s, unproject(half, texel_middle(x, y, size)));
                uint& texel = map[texel_index(half, x, y, size)];
                if (depth > 0) texel = min(texel, floatBitsToUint(depth));
            }
    }
}

}  // namespace

std::vector<uint> splat_ref(const compute::BshArrays& tree, std::span<const uvec2> groups, std::span<const View> views, uint first_view, uint maps,
                            uint map_size) {
    std::vector<uint> atlas(size_t(maps) * map_texels(map_size), atlas_nothing);
    for (const uvec2& code : groups) {
        const CutGroup g = cut_unpack(code);
        for (uint slot = 8 * g.block; slot < 8 * g.block + 8; ++slot)
            if ((g.drawn >> slot % 8 & 1) && opacity_in_view(bsh_missing(tree.boxes[slot]), g.view))
                draw(splat_of(views[g.view], tree.sphere(slot), tree.cones[slot], tree.boxes[slot]), map_size,
                     &atlas[size_t(g.view - first_view) * map_texels(map_size)]);
    }
    return atlas;
}

}  // namespace myriad::passes
