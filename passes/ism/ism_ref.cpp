#include "passes/ism/ism_ref.hpp"

namespace myriad::passes {

std::vector<IsmPoint> ism_points_ref(const compute::WorldTriangles& world, std::span<const SurfaceSample> samples) {
    std::vector<IsmPoint> points;
    for (const SurfaceSample& s : samples)
        points.push_back(ism_point(world.corners(s.triangle), s.u, s.v, world.opacity.blends() ? world.opacity.missing(world.place(s.triangle), s.u, s.v) : 0));
    return points;
}

std::vector<uint> ism_splat_ref(std::span<const IsmPoint> points, std::span<const View> views, const IsmSplatRef& in) {
    const uint size = in.map_size;
    std::vector<uint> atlas(size_t(in.maps) * map_texels(size), atlas_nothing);
    for (uint v = in.first_view; v < in.first_view + in.maps && v < views.size(); ++v)
        for (uint i = 0; i < in.subset; ++i) {
            const IsmPoint p = points[ism_chosen(v, i, in.subset, uint(points.size()), in.seed)];
            const IsmDisc s = ism_disc(views[v], p, in.radius);
            if (s.height == 0 || outside_frustum(views[v], s.d, s.radius) || !opacity_in_view(ism_missing(p), v)) continue;
            for (uint half : {half_front, half_back}) {
                if (half != half_of(s.d) && !splat_in_both(s.d, s.radius, size)) continue;
                const Footprint f = footprint(half, s.d, s.radius);
                const auto within = [&](uint x, float middle) { return splat_first(middle - f.radius, size) <= x && x < splat_end(middle + f.radius, size); };
                for (uint y = 0; y < size; ++y)
                    for (uint x = 0; x < size; ++x) {
                        if (!within(x, f.center.x) || !within(y, f.center.y)) continue;
                        const float depth = ism_depth(s, unproject(half, texel_middle(x, y, size)));
                        uint& texel = atlas[size_t(v - in.first_view) * map_texels(size) + texel_index(half, x, y, size)];
                        if (depth > 0) texel = min(texel, floatBitsToUint(depth));
                    }
            }
        }
    return atlas;
}

std::vector<uint> ism_pull_ref(std::span<const uint> fine, uint size, uint halves, float threshold) {
    const uint coarse = ism_coarser(size);
    std::vector<uint> out;
    for (uint h = 0; h < halves; ++h)
        for (uint y = 0; y < coarse; ++y)
            for (uint x = 0; x < coarse; ++x) {
                const auto at = [&](uint i, uint j) { return i < size && j < size ? uintBitsToFloat(fine[(h * size + j) * size + i]) : ism_nothing(); };
                out.push_back(floatBitsToUint(ism_mean({at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)}, vec4(1), threshold)));
            }
    return out;
}

void ism_push_ref(std::vector<uint>& fine, std::span<const uint> coarse, uint size, uint halves, float threshold) {
    const uint half_size = ism_coarser(size);
    for (uint h = 0; h < halves; ++h)
        for (uint y = 0; y < size; ++y)
            for (uint x = 0; x < size; ++x) {
                uint& texel = fine[(h * size + y) * size + x];
                if (texel != atlas_nothing) continue;
                const uvec4 from = h * half_size * half_size + ism_around(x, y, half_size);
                texel = floatBitsToUint(ism_mean({uintBitsToFloat(coarse[from.x]), uintBitsToFloat(coarse[from.y]), uintBitsToFloat(coarse[from.z]),
                                                  uintBitsToFloat(coarse[from.w])}, ism_weights, threshold));
            }
}

std::vector<uint> ism_fill_ref(std::vector<uint> maps, uint size, uint halves, float threshold, uint levels) {
    if (levels == 0 || size <= 1) return maps;
    std::vector<uint> coarse = ism_pull_ref(maps, size, halves, threshold);
    coarse = ism_fill_ref(std::move(coarse), ism_coarser(size), halves, 2 * threshold, levels - 1);
    ism_push_ref(maps, coarse, size, halves, threshold);
    return maps;
}

}  // namespace myriad::passes
