#include "passes/splat/splat_ref.hpp"

namespace myriad::passes {
namespace {

bool within(uint x, float middle, float radius, uint size) {
    return splat_first(middle - radius, size) <= x && x < splat_end(middle + radius, size);
}

void lower(uint& texel, float depth) {
    if (depth > 0) texel = min(texel, floatBitsToUint(depth));
}

void draw(const Splat& s, uint size, uint* map, uint coverage, uint dice) {
    if (s.height == 0) return;  // seen edge-on
    for (uint half : {half_front, half_back}) {
        if (half != half_of(s.d) && !splat_in_both(s.d, s.radius, size)) continue;
        const Footprint f = footprint(half, s.d, s.radius);
        if (coverage != coverage_exact && splat_is_small(f.radius * float(size))) {
            const SmallSplat small = splat_small(s, half, f.center, size, coverage, dice);
            lower(map[texel_index(half, small.x, small.y, size)], small.depth);
            continue;
        }
        for (uint y = 0; y < size; ++y)
            for (uint x = 0; x < size; ++x) {
                if (!within(x, f.center.x, f.radius, size) || !within(y, f.center.y, f.radius, size)) continue;
                lower(map[texel_index(half, x, y, size)], splat_depth(s, unproject(half, texel_middle(x, y, size))));
            }
    }
}

void draw_parallel(const View& view, const Splat& s, uint size, uint* map, uint coverage, uint dice) {
    const ParallelFrame frame = parallel_frame(view.direction);
    const vec2 middle = parallel_place(view, frame, s.d, size);
    const uint columns = parallel_columns(view);
    const float texel = parallel_texel(view, size), radius = s.radius / texel;
    if (coverage != coverage_exact && splat_is_small(2 * radius)) {
        const SmallSplat small = splat_small_parallel(s, view, frame, middle, size, coverage, dice);
        return lower(map[small.y * columns + small.x], small.depth);
    }
    for (uint y = 0; y < parallel_rows(view, size); ++y)
        for (uint x = 0; x < columns; ++x) {
            if (x < parallel_first(middle.x, radius, columns) || x >= parallel_end(middle.x, radius, columns)) continue;
            if (y < parallel_first(middle.y, radius, parallel_rows(view, size)) || y >= parallel_end(middle.y, radius, parallel_rows(view, size))) continue;
            const vec3 off = (float(x) + 0.5f - middle.x) * texel * frame.across + (float(y) + 0.5f - middle.y) * texel * frame.down;
            lower(map[y * columns + x], splat_parallel_depth(s, view.direction, off));
        }
}

}  // namespace

std::vector<uint> splat_ref(const compute::BshArrays& tree, std::span<const uvec2> groups, std::span<const View> views, uint first_view, uint maps,
                            uint map_size, uint coverage) {
    std::vector<uint> atlas(size_t(maps) * map_texels(map_size), atlas_nothing);
    for (const uvec2& code : groups) {
        const CutGroup g = cut_unpack(code);
        for (uint slot = tree.arity() * g.block; slot < tree.arity() * (g.block + 1); ++slot)
            if ((g.drawn >> slot % tree.arity() & 1) && opacity_in_view(bsh_missing(tree.boxes[slot]), g.view)) {
                const View& view = views[g.view];
                const Splat s = splat_of(view, tree.sphere(slot), tree.cones[slot], tree.boxes[slot]);
                uint* map = &atlas[size_t(g.view - first_view) * map_texels(map_size)];
                if (is_parallel(view)) draw_parallel(view, s, map_size, map, coverage, splat_dice(slot, g.view));
                else draw(s, map_size, map, coverage, splat_dice(slot, g.view));
            }
    }
    return atlas;
}

}  // namespace myriad::passes
