#include "tools/view/raster.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/parallel.hpp"

namespace myriad::tools::view {
namespace {

struct Box {
    int x0, y0, x1, y1;  // x1 and y1 are outside
};

struct Target {
    uint32_t* pixels;
    uint32_t width;
};

uint32_t channel(uint32_t rgba, int c) { return rgba >> 8 * c & 255; }

// a * b / 255, rounded.
uint32_t times(uint32_t a, uint32_t b) {
    const uint32_t p = a * b + 128;
    return (p + (p >> 8)) >> 8;
}

uint32_t multiplied(uint32_t a, uint32_t b) {
    uint32_t out = 0;
    for (int c = 0; c < 4; ++c) out |= times(channel(a, c), channel(b, c)) << 8 * c;
    return out;
}

void blend(uint32_t& under, uint32_t over) {
    const uint32_t alpha = over >> 24;
    if (alpha == 255) return void(under = over);
    if (alpha == 0) return;
    uint32_t out = 0xff000000u;
    for (int c = 0; c < 3; ++c) out |= (times(channel(over, c), alpha) + times(channel(under, c), 255 - alpha)) << 8 * c;
    under = out;
}

uint32_t texel(const Texture& t, int x, int y) { return t.texels[size_t(std::clamp(y, 0, int(t.height) - 1)) * t.width + size_t(std::clamp(x, 0, int(t.width) - 1))]; }

// a, and `part` of 256 of the way to b; two channels at once.
uint32_t between(uint32_t a, uint32_t b, uint32_t part) {
    constexpr uint32_t two = 0x00ff00ffu;
    const uint32_t even = (((a & two) * (256 - part) + (b & two) * part) >> 8) & two;
    const uint32_t odd = ((a >> 8 & two) * (256 - part) + (b >> 8 & two) * part) & ~two;
    return even | odd;
}

uint32_t sample(const Texture& t, float u, float v) {
    const float x = u * float(t.width), y = v * float(t.height);
    if (!t.smooth) return texel(t, int(std::floor(x)), int(std::floor(y)));
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const uint32_t fx = uint32_t((x - 0.5f - left) * 256), fy = uint32_t((y - 0.5f - top) * 256);
    const uint32_t up = between(texel(t, int(left), int(top)), texel(t, int(left) + 1, int(top)), fx);
    const uint32_t down = between(texel(t, int(left), int(top) + 1), texel(t, int(left) + 1, int(top) + 1), fx);
    return between(up, down, fy);
}

// Corners of a triangle, in 1/16 pixels, so that which side of an edge a middle is on is exact.
struct Point {
    int64_t x, y;
};
Point snapped(const ImVec2& p) { return {std::llround(double(p.x) * 16), std::llround(double(p.y) * 16)}; }
int64_t side(const Point& a, const Point& b, const Point& p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }
// Whether middles on the edge itself belong to it: those of left and top edges do.
bool owns(const Point& a, const Point& b) { return b.y < a.y || (a.y == b.y && b.x > a.x); }

void triangle(const Target& target, const Box& clip, const Texture& texture, std::array<const ImDrawVert*, 3> v) {
    std::array<Point, 3> p = {snapped(v[0]->pos), snapped(v[1]->pos), snapped(v[2]->pos)};
    int64_t area = side(p[0], p[1], p[2]);
    if (area == 0) return;
    if (area < 0) std::swap(p[1], p[2]), std::swap(v[1], v[2]), area = -area;
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
    const int x0 = std::max(clip.x0, int((left - 8) >> 4)), x1 = std::min(clip.x1, int((right + 8) >> 4) + 1);
    const int y0 = std::max(clip.y0, int((top - 8) >> 4)), y1 = std::min(clip.y1, int((bottom + 8) >> 4) + 1);
    std::array<int64_t, 3> bias, step;
    for (int e = 0; e < 3; ++e) {
        const Point &a = p[size_t(e + 1) % 3], &b = p[size_t(e + 2) % 3];  // opposite of corner e
        bias[size_t(e)] = owns(a, b) ? 0 : -1;
        step[size_t(e)] = -(b.y - a.y) * 16;
    }
    const bool plain = v[0]->col == v[1]->col && v[0]->col == v[2]->col;
    const bool still = v[0]->uv.x == v[1]->uv.x && v[0]->uv.x == v[2]->uv.x && v[0]->uv.y == v[1]->uv.y && v[0]->uv.y == v[2]->uv.y;
    const uint32_t fixed = still && plain ? multiplied(v[0]->col, sample(texture, v[0]->uv.x, v[0]->uv.y)) : 0;
    for (int y = y0; y < y1; ++y) {
        const Point start{int64_t(x0) * 16 + 8, int64_t(y) * 16 + 8};
        std::array<int64_t, 3> w = {side(p[1], p[2], start), side(p[2], p[0], start), side(p[0], p[1], start)};
        for (int x = x0; x < x1; ++x, w[0] += step[0], w[1] += step[1], w[2] += step[2]) {
            if (w[0] + bias[0] < 0 || w[1] + bias[1] < 0 || w[2] + bias[2] < 0) continue;
            uint32_t& pixel = target.pixels[size_t(y) * target.width + size_t(x)];
            if (still && plain) {
                blend(pixel, fixed);
                continue;
            }
            const float a = float(w[0]) / float(area), b = float(w[1]) / float(area), c = 1 - a - b;
            uint32_t colour = v[0]->col;
            if (!plain) {
                colour = 0;
                for (int k = 0; k < 4; ++k) {
                    const float mix = a * float(channel(v[0]->col, k)) + b * float(channel(v[1]->col, k)) + c * float(channel(v[2]->col, k));
                    colour |= uint32_t(std::clamp(mix + 0.5f, 0.0f, 255.0f)) << 8 * k;
                }
            }
            blend(pixel, multiplied(colour, sample(texture, a * v[0]->uv.x + b * v[1]->uv.x + c * v[2]->uv.x, a * v[0]->uv.y + b * v[1]->uv.y + c * v[2]->uv.y)));
        }
    }
}

// Panels, letters and pictures are rectangles along the axes, of one colour: corners a, b, c, d around, as triangles a b c and a c d.
bool is_rectangle(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c, const ImDrawVert& d) {
    return a.pos.y == b.pos.y && b.pos.x == c.pos.x && c.pos.y == d.pos.y && d.pos.x == a.pos.x && a.pos.x < b.pos.x && a.pos.y < c.pos.y && a.col == b.col &&
           a.col == c.col && a.col == d.col && a.uv.y == b.uv.y && b.uv.x == c.uv.x && c.uv.y == d.uv.y && d.uv.x == a.uv.x;
}

void rectangle(const Target& target, const Box& clip, const Texture& texture, const ImDrawVert& a, const ImDrawVert& c) {
    const auto first = [](float edge) { return int(std::ceil(double(std::llround(double(edge) * 16)) / 16 - 0.5)); };  // pixel whose middle is within
    const int x0 = std::max(clip.x0, first(a.pos.x)), x1 = std::min(clip.x1, first(c.pos.x));
    const int y0 = std::max(clip.y0, first(a.pos.y)), y1 = std::min(clip.y1, first(c.pos.y));
    const float du = (c.uv.x - a.uv.x) / (c.pos.x - a.pos.x), dv = (c.uv.y - a.uv.y) / (c.pos.y - a.pos.y);
    const bool still = du == 0 && dv == 0;
    const uint32_t fixed = still ? multiplied(a.col, sample(texture, a.uv.x, a.uv.y)) : 0;
    for (int y = y0; y < y1; ++y) {
        uint32_t* row = target.pixels + size_t(y) * target.width;
        const float v = a.uv.y + (float(y) + 0.5f - a.pos.y) * dv;
        if (still && fixed >> 24 == 255) std::fill(row + x0, row + std::max(x0, x1), fixed);
        else
            for (int x = x0; x < x1; ++x) {
                const uint32_t texel = still ? fixed : sample(texture, a.uv.x + (float(x) + 0.5f - a.pos.x) * du, v);
                blend(row[x], still || a.col == ~0u ? texel : multiplied(a.col, texel));
            }
    }
}

void list(const ImDrawList& list, const ImVec2& origin, const Target& target, const Box& band) {
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback) continue;  // there are none
        const auto pixel = [](float edge) { return int(std::floor(std::clamp(edge, -1e6f, 1e6f))); };
        const Box clip{std::max(band.x0, pixel(command.ClipRect.x - origin.x)), std::max(band.y0, pixel(command.ClipRect.y - origin.y)),
                       std::min(band.x1, pixel(command.ClipRect.z - origin.x)), std::min(band.y1, pixel(command.ClipRect.w - origin.y))};
        const Texture& texture = *static_cast<const Texture*>(command.TextureId);
        if (clip.x0 >= clip.x1 || clip.y0 >= clip.y1 || !texture.texels) continue;
        const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
        const auto vertex = [&](uint32_t i) -> const ImDrawVert& { return list.VtxBuffer[int(index[i] + command.VtxOffset)]; };
        for (uint32_t i = 0; i + 3 <= command.ElemCount; i += 3) {
            if (i + 6 <= command.ElemCount && index[i] == index[i + 3] && index[i + 2] == index[i + 4] &&
                is_rectangle(vertex(i), vertex(i + 1), vertex(i + 2), vertex(i + 5))) {
                rectangle(target, clip, texture, vertex(i), vertex(i + 2));
                i += 3;
            } else {
                triangle(target, clip, texture, {&vertex(i), &vertex(i + 1), &vertex(i + 2)});
            }
        }
    }
}

}  // namespace

void draw(const ImDrawData& data, std::span<uint32_t> target, uint32_t width, uint32_t height) {
    constexpr size_t band = 32;  // rows
    engine::parallel_pieces(height, band, [&](size_t begin, size_t end) {
        for (int i = 0; i < data.CmdListsCount; ++i)
            list(*data.CmdLists[i], data.DisplayPos, {target.data(), width}, {0, int(begin), int(width), int(end)});
    });
}

}  // namespace myriad::tools::view
