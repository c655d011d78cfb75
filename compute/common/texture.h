// Where a texture is looked up, and between which texels: the formulae of filtering, for kernels, their twins and the host.
// Textures are RGBA8 words, R lowest, row by row, in one plain array: no descriptors, which end at 128 MiB on lavapipe. One
// level, bilinear.
#ifndef MYRIAD_COMPUTE_TEXTURE_H
#define MYRIAD_COMPUTE_TEXTURE_H

#include "engine/shared.h"

#ifdef __cplusplus
#define precise
#endif

MYRIAD_BEGIN
const uint wrap_repeat = 0u, wrap_clamp = 1u, wrap_mirror = 2u;

// A texture as a material uses it; width 0: there is none.
struct TextureRef {
    uint first;              // index of its first word among the texels
    uint width, height;
    uint use;                // wrap of u, of v << 2, set of texture coordinates << 4
    vec2 along_u, along_v, origin;  // (u, v) on the texture = along_u * u + along_v * v + origin
};
MYRIAD_ARRAY(TextureRefs, TextureRef, 4)
MYRIAD_ARRAY(Vec2s, vec2, 4)

MYRIAD_FN uint texture_set(TextureRef t) { return t.use >> 4; }

MYRIAD_FN vec2 texture_place(TextureRef t, vec2 uv) {
    precise const vec2 place = t.along_u * uv.x + t.along_v * uv.y + t.origin;
    return place;
}

// A texel coordinate in [0, size), from one that may be outside by up to a period of the wrap mode.
MYRIAD_FN uint wrap_texel(int i, uint size, uint mode) {
    const int n = int(size);
    if (mode == wrap_clamp) return uint(clamp(i, 0, n - 1));
    if (mode == wrap_mirror) {
        const int folded = i < 0 ? i + 2 * n : i >= 2 * n ? i - 2 * n : i;
        return uint(folded < n ? folded : 2 * n - 1 - folded);
    }
    return uint(i < 0 ? i + n : i >= n ? i - n : i);
}

// The two texels that a bilinear filter blends along one axis, whose centres are at (i + 0.5) / size, as in glTF.
struct TexelPair {
    uint low, high;
    float weight;        // of `high`
};
MYRIAD_FN TexelPair texel_pair(float t, uint size, uint mode) {
    if (!(abs(t) < 16777216.0f)) t = 0.0f;                              // no fraction is left there, or not a number
    if (mode == wrap_repeat) t -= floor(t);
    if (mode == wrap_mirror) t -= 2.0f * floor(0.5f * t);
    if (mode == wrap_clamp) t = clamp(t, 0.0f, 1.0f);
    precise const float x = t * float(size) - 0.5f;
    const float whole = floor(x);
    TexelPair pair;
    pair.low = wrap_texel(int(whole), size, mode);
    pair.high = wrap_texel(int(whole) + 1, size, mode);
    pair.weight = x - whole;
    return pair;
}

// The four texels around a place: words of the texel array, the upper row first, and the weights of the right and the lower.
struct TexelQuad {
    uvec4 word;
    vec2 weight;
};
MYRIAD_FN TexelQuad texel_quad(TextureRef t, vec2 place) {
    const TexelPair x = texel_pair(place.x, t.width, t.use & 3u);
    const TexelPair y = texel_pair(place.y, t.height, (t.use >> 2) & 3u);
    const uint top = t.first + y.low * t.width;
    const uint bottom = t.first + y.high * t.width;
    TexelQuad quad;
    quad.word = uvec4(top + x.low, top + x.high, bottom + x.low, bottom + x.high);
    quad.weight = vec2(x.weight, y.weight);
    return quad;
}
MYRIAD_END

#ifdef __cplusplus
#undef precise
static_assert(sizeof(myriad::TextureRef) == 40);
#endif

#endif
