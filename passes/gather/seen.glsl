// What a VPL's map, which begins at word `map` of the atlas, lets it see of a receiver: 0 to 1.
#include "passes/gather/gather_io.h"

float seen_in_texel(MapQuery q, int right, int below, Uints atlas, uint map, uint size) {
    const MapTexel t = map_texel(q, right, below, size);
    return map_seen(uintBitsToFloat(atlas.at[map + t.index]), t);
}
float seen_in_map(vec3 x, vec3 n_g, vec3 vpl_position, Uints atlas, uint map, uint size, float bias) {
    const MapQuery q = map_query(x, n_g, vpl_position, size, bias);
    return map_blend(q, vec4(seen_in_texel(q, 0, 0, atlas, map, size), seen_in_texel(q, 1, 0, atlas, map, size),
                             seen_in_texel(q, 0, 1, atlas, map, size), seen_in_texel(q, 1, 1, atlas, map, size)));
}
