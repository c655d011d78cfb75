#include "compute/surface_sampling/surface_sampling.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <tuple>

#include "compute/common/radix_sort.hpp"
#include "engine/parallel.hpp"

namespace myriad::compute {
namespace {

using glm::dvec2, glm::dvec3;

constexpr size_t grain = 1 << 14;  // triangles or shares that a thread takes at a time

double squared(dvec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

struct Corner {
    dvec3 position;
    dvec2 uv;
};
Corner middle(const Corner& a, const Corner& b) { return {0.5 * (a.position + b.position), 0.5 * (a.uv + b.uv)}; }

// A part of a triangle, on a curve that enters at one vertex and leaves at another.
struct Piece {
    Corner in, apex, out;

    // Halves it across its longest edge. The second half begins where the first ends.
    std::array<Piece, 2> halves() const {
        const double across = squared(out.position - in.position);
        const double rise = squared(apex.position - in.position), fall = squared(out.position - apex.position);
        if (across >= rise && across >= fall) {
            const Corner m = middle(in, out);
            return {{{in, m, apex}, {apex, m, out}}};
        }
        if (rise >= fall) {
            const Corner m = middle(in, apex);
            return {{{in, out, m}, {m, apex, out}}};
        }
        const Corner m = middle(apex, out);
        return {{{in, apex, m}, {m, in, out}}};
    }

    dvec3 center() const { return (in.position + apex.position + out.position) / 3.0; }
    double area() const { return 0.5 * std::sqrt(squared(glm::cross(apex.position - in.position, out.position - in.position))); }

    double longest() const {  // edge, squared
        return std::max({squared(apex.position - in.position), squared(out.position - in.position), squared(out.position - apex.position)});
    }
    bool is_thin() const { return longest() > 6 * area(); }  // times 2.3: equilateral, 4: right isosceles

    // The same with its longest edge between the first two corners: with the widest angle last, half-filled levels of the
    // sequence below are at their most even.
    Piece with_longest_first() const {
        const double across = squared(out.position - in.position);
        const double rise = squared(apex.position - in.position), fall = squared(out.position - apex.position);
        return across >= rise && across >= fall ? Piece{in, out, apex} : rise >= fall ? *this : Piece{apex, out, in};
    }

    // Sample i of the low-discrepancy sequence of Basu and Owen (2015): van der Corput's in base 4, with the four
    // similar triangles of a subdivision for digits.
    dvec2 point(uint64_t i) const {
        const auto [a, b, c] = part(i, (int(std::bit_width(i)) + 1) / 2);
        return (a + b + c) / 3.0;  // further digits are zeros: the middle's middle is the middle
    }
    // The triangle that its first `levels` digits lead to.
    std::array<dvec2, 3> part(uint64_t i, int levels) const {
        dvec2 a = in.uv, b = apex.uv, c = out.uv;
        for (; levels > 0; --levels, i >>= 2) {
            const dvec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
            switch (i & 3) {
                case 0: a = bc, b = ca, c = ab; break;
                case 1: b = ab, c = ca; break;
                case 2: a = ab, c = bc; break;
                case 3: a = ca, b = bc; break;
            }
        }
        return {a, b, c};
    }
};

// A number in [0, 1) from two; its quality hardly matters here.
double hashed(uint32_t a, uint32_t b) {
    uint64_t h = (uint64_t(a) << 32 | b) * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
    return double((h ^ h >> 32) >> 11) * 0x1p-53;
}

// 21 bits, two zeros between any two of them.
uint64_t spread(uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffu;
    v = (v | v << 16) & 0x001f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    return (v | v << 2) & 0x1249249249249249u;
}

// Where a point of the unit cube is on Hilbert's curve of 2^63 cells (Skilling 2004). Without branches: they would go either
// way, and millions of points come here.
uint64_t hilbert(dvec3 p) {
    const auto cell = [](double v) { return uint32_t(std::clamp(v, 0.0, 1.0) * 2097151.0); };
    uint32_t x = cell(p.x), y = cell(p.y), z = cell(p.z);
    for (int bit = 20; bit > 0; --bit) {
        const uint32_t below = (1u << bit) - 1;
        x ^= below & (0u - (x >> bit & 1));
        for (uint32_t* v : {&y, &z}) {
            const uint32_t set = 0u - (*v >> bit & 1), flip = below & set, swap = (x ^ *v) & below & ~set;
            x ^= flip ^ swap;
            *v ^= swap;
        }
    }
    y ^= x, z ^= y;
    uint32_t turn = z >> 1;  // then of each bit: whether the bits above it are odd in number
    for (int shift = 1; shift < 32; shift *= 2) turn ^= turn >> shift;
    return spread(x ^ turn) << 2 | spread(y ^ turn) << 1 | spread(z ^ turn);
}

Piece whole(const Corners& c) { return {{dvec3(c.p0), {0, 0}}, {dvec3(c.p1), {1, 0}}, {dvec3(c.p2), {0, 1}}}; }

double finite_area(const Piece& piece) {
    const double area = piece.area();
    return std::isfinite(area) ? area : 0;
}

// What is sampled: a fat triangle, or a part of a thin one.
struct Share {
    uint64_t curve;     // where it is on a curve through space
    double area;
    uint32_t triangle;
    uint32_t path;      // which halves it is, from the highest bit on, after a leading 1

    bool asks = false;  // whether it is there, point by point

    Piece piece(const WorldTriangles& world) const {
        Piece piece = whole(world.corners(triangle));
        for (int bit = int(std::bit_width(path)) - 2; bit >= 0; --bit) piece = piece.halves()[path >> bit & 1];
        return piece;
    }
};

// Cuts what is thin and longer than a sample's share, unless it is worth less than a sixteenth of a sample: so there are at
// most 32 n more shares than triangles. A row of needles would otherwise get its samples in a row: all in the middle.
void cut(const Piece& piece, Share share, double sample_area, std::vector<Share>& shares, std::vector<dvec3>& centers) {
    if (share.area < sample_area / 16 || share.path >> 30 || piece.longest() < 2 * sample_area || !piece.is_thin()) {
        shares.push_back(share);
        centers.push_back(piece.center());
        return;
    }
    const auto halves = piece.halves();
    for (uint32_t i = 0; i < 2; ++i)
        cut(halves[i], {0, 0.5 * share.area, share.triangle, 2 * share.path + i, share.asks}, sample_area, shares, centers);
}

// ---- Triangles that are there in part (compute/opacity) ----

// Points of a part: for how much of it is there, and for its samples. They take the sequence's triangles in turn, at a level of some
// four a sample that would be due if it were whole, and are anywhere in each: the sequence's own points, at halves and quarters, fall on
// the grid of textures, and are the same for all leaves of a tree.
class Candidates {
public:
    // `sample_area`: of a sample if everything were whole.
    Candidates(const WorldTriangles& world, const Share& share, double sample_area, uint32_t seed)
        : world_(world), place_(world.place(share.triangle)), piece_(share.piece(world).with_longest_first()), triangle_(share.triangle),
          seed_(seed + 7919 * share.path) {
        const double due = piece_.area() / sample_area;
        while (levels_ < 8 && questions() < 4 * due) ++levels_;
    }

    double part_there() const {
        uint64_t kept = 0;
        for (uint64_t i = 0; i < questions(); ++i) kept += is_kept(point(i));
        return double(kept) / double(questions());
    }

    // The first ones that are there. It asks on, and comes to repeat itself only where there is very little.
    void sample(uint64_t count, SurfaceSample* samples) const {
        uint64_t found = 0;
        for (uint64_t i = 0; i < 16 * (questions() + count) && found < count; ++i)
            if (const dvec2 uv = point(i); is_kept(uv)) samples[found++] = {triangle_, float(uv.x), float(uv.y)};
        assert(found > 0 && "a share of which nothing is there has no area");
        for (uint64_t i = found; i < count; ++i) samples[i] = samples[i - found];
    }

private:
    uint64_t questions() const { return uint64_t(1) << 2 * levels_; }
    dvec2 point(uint64_t i) const {
        const auto [a, b, c] = piece_.part(i, levels_);
        const double r = std::sqrt(hashed(triangle_, seed_ + 2 * uint32_t(i))), s = hashed(triangle_, seed_ + 2 * uint32_t(i) + 1);
        return (1 - r) * a + r * (1 - s) * b + r * s * c;
    }
    bool is_kept(const dvec2& uv) const { return world_.opacity.is_kept(place_, float(uv.x), float(uv.y)); }

    const WorldTriangles& world_;
    OpacityPlace place_;
    Piece piece_;
    uint32_t triangle_, seed_;
    int levels_ = 2;  // of the sequence's subdivision: at least 16 questions, at most 65536
};

// What a piece of the triangles is cut into, in their order.
struct Cuts {
    std::vector<Share> shares;
    std::vector<dvec3> centers;
    dvec3 low{HUGE_VAL}, high{-HUGE_VAL};  // of the centres

    void keep_what_is_there(const WorldTriangles& world, double sample_area, uint32_t seed) {
        size_t kept = 0;
        for (size_t i = 0; i < shares.size(); ++i) {
            if (shares[i].asks) shares[i].area *= Candidates(world, shares[i], sample_area, seed).part_there();
            if (shares[i].area > 0) shares[kept] = shares[i], centers[kept++] = centers[i];
        }
        shares.resize(kept), centers.resize(kept);
    }
};

// All shares of the surface along Hilbert's curve: systematic samples of small neighbours are then even, too. Where they tie
// there, the triangle's number decides, and the path in it: there is one order.
std::vector<Share> ordered_shares(const WorldTriangles& world, std::span<const double> areas, double sample_area, uint32_t seed, uint32_t threads) {
    std::vector<Cuts> cuts((areas.size() + grain - 1) / grain);
    engine::parallel_pieces(areas.size(), grain, [&](size_t begin, size_t end) {
        Cuts& here = cuts[begin / grain];
        here.shares.reserve(end - begin), here.centers.reserve(end - begin);
        world.for_each(uint32_t(begin), uint32_t(end), [&](uint32_t t, uint32_t stored, const Corners& corners) {
            const bool asks = world.opacity.kind(stored) == Opacity::Kind::asks;
            if (areas[t] > 0) cut(whole(corners), {0, areas[t], t, 1, asks}, sample_area, here.shares, here.centers);
        });
        if (!world.opacity.everywhere()) here.keep_what_is_there(world, sample_area, seed);
        for (const dvec3& c : here.centers) here.low = glm::min(here.low, c), here.high = glm::max(here.high, c);
    }, threads);

    std::vector<size_t> first{0};
    dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const Cuts& c : cuts) low = glm::min(low, c.low), high = glm::max(high, c.high), first.push_back(first.back() + c.shares.size());
    const dvec3 extent = high - low;
    const double scale = 1 / std::max({extent.x, extent.y, extent.z, 1e-300});
    struct Place {
        uint64_t curve;
        uint64_t share;
    };
    std::vector<Share> shares(first.back());
    std::vector<Place> places(shares.size());
    engine::parallel_pieces(cuts.size(), 1, [&](size_t c, size_t) {
        for (size_t i = 0; i < cuts[c].shares.size(); ++i) {
            Share share = cuts[c].shares[i];
            share.curve = hilbert((cuts[c].centers[i] - low) * scale);
            places[first[c] + i] = {share.curve, first[c] + i};
            shares[first[c] + i] = share;
        }
        cuts[c] = {};
    }, threads);

    // The upper half of the curve's bits sorts nearly all of it; what shares a cell there is compared in full.
    radix_sort(places, [](const Place& p) { return p.curve; }, 30, 63, threads);
    const auto cell = [&](size_t i) { return places[i].curve >> 30; };
    std::vector<size_t> ends{0};  // of pieces that no run of one cell straddles
    while (ends.back() < places.size()) {
        size_t end = std::min(ends.back() + grain, places.size());
        while (end < places.size() && cell(end) == cell(end - 1)) ++end;
        ends.push_back(end);
    }
    engine::parallel_pieces(ends.size() - 1, 1, [&](size_t which, size_t) {
        for (size_t run = ends[which], next; run < ends[which + 1]; run = next) {
            for (next = run + 1; next < ends[which + 1] && cell(next) == cell(run);) ++next;
            if (next - run == 1) continue;
            std::sort(places.begin() + ptrdiff_t(run), places.begin() + ptrdiff_t(next), [&](const Place& a, const Place& b) {
                const Share &x = shares[a.share], &y = shares[b.share];
                return std::tie(x.curve, x.triangle, x.path) < std::tie(y.curve, y.triangle, y.path);
            });
        }
    }, threads);
    std::vector<Share> ordered(shares.size());
    engine::parallel_pieces(places.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) ordered[i] = shares[places[i].share];
    }, threads);
    return ordered;
}

void sample_share(const WorldTriangles& world, const Share& share, uint64_t count, double expected, uint32_t seed, SurfaceSample* samples) {
    const Piece piece = share.piece(world).with_longest_first();
    for (uint64_t i = 0; i < count; ++i) {
        dvec2 uv = piece.point(i);
        if (expected < 0.5) {  // what stands for several of its like has no reason to be hit in the middle
            const double r = std::sqrt(hashed(share.triangle, seed + share.path)), s = hashed(~share.triangle, seed + share.path);
            const dvec2 anywhere = (1 - r) * piece.in.uv + r * (1 - s) * piece.apex.uv + r * s * piece.out.uv;
            uv = glm::mix(anywhere, uv, 2 * expected);
        }
        samples[i] = {share.triangle, float(uv.x), float(uv.y)};
    }
}

// Where nothing has area: vertices in turn, of finite triangles.
std::vector<SurfaceSample> sample_vertices(const WorldTriangles& world, uint64_t n) {
    std::vector<uint32_t> finite;
    world.for_each([&](uint32_t t, uint32_t, const Corners& c) {
        if (std::isfinite(squared(dvec3(c.p0)) + squared(dvec3(c.p1)) + squared(dvec3(c.p2)))) finite.push_back(t);
    });
    std::vector<SurfaceSample> samples(finite.empty() ? 0 : n);
    for (size_t i = 0; i < samples.size(); ++i) {
        const size_t corner = i / finite.size() % 3;
        samples[i] = {finite[i % finite.size()], corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f};
    }
    return samples;
}

}  // namespace

SurfaceSampling sample_surface(const WorldTriangles& world, uint32_t log2_count, uint32_t seed, uint32_t threads) {
    assert(log2_count < 32 && world.triangles.size() < uint64_t(1) << 32);
    SurfaceSampling result;
    const uint64_t n = uint64_t(1) << log2_count;
    std::vector<double> areas(world.count());
    engine::parallel_pieces(areas.size(), grain, [&](size_t begin, size_t end) {
        world.for_each(uint32_t(begin), uint32_t(end), [&](uint32_t t, uint32_t stored, const Corners& corners) {
            if (world.opacity.kind(stored) != Opacity::Kind::nowhere) areas[t] = finite_area(whole(corners));
        });
    }, threads);
    for (const double area : areas) result.area += area;
    const double whole_sample_area = result.area / double(n);  // if everything were whole
    const std::vector<Share> shares = result.area > 0 ? ordered_shares(world, areas, whole_sample_area, seed, threads) : std::vector<Share>{};
    if (std::any_of(shares.begin(), shares.end(), [](const Share& s) { return s.asks; })) {
        result.area = 0;
        for (const Share& share : shares) result.area += share.area;
    }
    if (shares.empty()) {
        result.samples = sample_vertices(world, n);
        return result;
    }
    result.samples.resize(n);
    const double sample_area = result.area / double(n);
    result.radius = float(surface_sample_cover * std::sqrt(sample_area / std::numbers::pi));

    // Systematic sampling: sample i is at (i + phase) / n of the cumulative area, so each share gets the floor or the
    // ceiling of what it is due. One sum in one order, whatever the threads; then each share is on its own.
    const double phase = hashed(seed, 0);
    std::vector<uint32_t> first(shares.size() + 1);
    double sum = 0;
    for (size_t i = 0; i < shares.size(); ++i) {
        sum += shares[i].area;
        first[i + 1] = uint32_t(std::clamp(uint64_t(std::max(0.0, std::ceil(sum / sample_area - phase))), uint64_t(first[i]), n));
    }
    first.back() = uint32_t(n);
    engine::parallel_pieces(shares.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Share& share = shares[i];
            const uint32_t count = first[i + 1] - first[i];
            SurfaceSample* samples = &result.samples[first[i]];
            if (count > 0 && share.asks) Candidates(world, share, whole_sample_area, seed).sample(count, samples);
            else if (count > 0) sample_share(world, share, count, share.area / sample_area, seed, samples);
        }
    }, threads);
    return result;
}

}  // namespace myriad::compute
