#include "compute/opacity/opacity.hpp"

#include <algorithm>
#include <cassert>

namespace myriad::compute {

Opacity::Opacity(std::span<const uvec4> triangles, std::span<const vec2> texcoords, std::span<const vec2> texcoords1, std::span<const vec4> colors,
                 std::span<const OpacityMaterial> materials, std::span<const uint> texels)
    : triangles_(triangles), texcoords_{texcoords, texcoords1}, colors_(colors), materials_(materials), texels_(texels) {
    for (const OpacityMaterial& m : materials) {
        Range range{m.alpha, m.alpha};
        // Filtered texels lie between the least and the largest.
        if (const uint64_t count = uint64_t(m.texture.width) * m.texture.height; count > 0 && m.cutoff != 0) {
            const auto own = texels.subspan(m.texture.first, count);
            const auto [low, high] = std::minmax_element(own.begin(), own.end(), [](uint a, uint b) { return a >> 24 < b >> 24; });
            range = {m.alpha * (float(*low >> 24) / 255), m.alpha * (float(*high >> 24) / 255)};
        }
        ranges_.push_back(range);
        if (m.cutoff == 0 || (colors.empty() && range.low >= (m.cutoff > 0 ? m.cutoff : 1))) continue;
        everywhere_ = false;
        blends_ = blends_ || m.cutoff < 0;
    }
}

Opacity::Kind Opacity::kind(uint32_t triangle) const {
    if (everywhere_) return Kind::everywhere;
    const uvec4& corners = triangles_[triangle];
    const float cutoff = materials_[corners.w].cutoff;
    Range range = ranges_[corners.w];
    if (!colors_.empty()) {
        const float a = colors_[corners.x].a, b = colors_[corners.y].a, c = colors_[corners.z].a;
        range.low *= std::min({a, b, c}), range.high *= std::max({a, b, c});
    }
    if (range.low >= (cutoff >= 0 ? cutoff : 1)) return Kind::everywhere;
    return (cutoff >= 0 ? range.high < cutoff : range.high <= 0) ? Kind::nowhere : Kind::asks;
}

vec2 Opacity::texcoord(uint32_t set, const uvec4& corners, float u, float v) const {
    const vec2 a = texcoords_[set][corners.x], b = texcoords_[set][corners.y], c = texcoords_[set][corners.z];
    return {opacity_at_point(a.x, b.x, c.x, u, v), opacity_at_point(a.y, b.y, c.y, u, v)};
}

uvec4 Opacity::corners(OpacityPlace at) const {
    const uvec4& c = triangles_[at.triangle];
    return at.mirrored ? uvec4(c.x, c.z, c.y, c.w) : c;
}

float Opacity::alpha(OpacityPlace at, float u, float v) const {
    if (materials_.empty()) return 1;
    const uvec4 c = corners(at);
    const OpacityMaterial& m = materials_[c.w];
    float alpha = m.alpha;
    if (!colors_.empty()) alpha *= opacity_at_point(colors_[c.x].a, colors_[c.y].a, colors_[c.z].a, u, v);
    if (m.texture.width > 0) {
        const TexelQuad q = texel_quad(m.texture, texture_place(m.texture, texcoord(texture_set(m.texture), c, u, v)));
        alpha *= opacity_of_texels({texels_[q.word.x], texels_[q.word.y], texels_[q.word.z], texels_[q.word.w]}, q.weight);
    }
    return alpha;
}

bool Opacity::is_there(OpacityPlace at, uint32_t id, float u, float v, uint dice) const {
    if (everywhere_) return true;
    return opacity_decides(alpha(at, u, v), materials_[triangles_[at.triangle].w].cutoff, id, u, v, dice);
}

uint Opacity::missing(OpacityPlace at, float u, float v) const {
    if (everywhere_) return 0;
    const float a = alpha(at, u, v), cutoff = materials_[triangles_[at.triangle].w].cutoff;
    return cutoff >= 0 ? (a >= cutoff ? 0 : opacity_nothing) : opacity_missing(a);
}

float Opacity::mean(OpacityPlace at, float u, float v) const {
    if (everywhere_) return 1;
    const float a = alpha(at, u, v), cutoff = materials_[triangles_[at.triangle].w].cutoff;
    return cutoff >= 0 ? float(a >= cutoff) : std::clamp(a, 0.0f, 1.0f);
}

std::array<std::span<const std::byte>, 5> Opacity::content() const {
    if (everywhere_) return {};
    return {std::as_bytes(texcoords_[0]), std::as_bytes(texcoords_[1]), std::as_bytes(colors_), std::as_bytes(materials_), std::as_bytes(texels_)};
}

}  // namespace myriad::compute
