#include "tools/bench/native_cut.hpp"

#include <algorithm>
#include <bit>
#include <thread>

#include "compute/manylods/manylods_io.h"

namespace myriad::tools {
namespace {

// What compute/manylods/manylods_io.h's classify_child says of each of a block's children: drawn | culled << 8 | open << 16.
// Loops over a constant number, without branches, so that they vectorise; the arithmetic is that of the shared header.
template <uint arity>
inline uint open_block(const NativeTree& tree, uint block, const View& view, float epsilon, float map_size) {
    const vec4 frame = tree.frames[block];
    const uvec2* codes = &tree.spheres[size_t(block) * arity];
    float x[arity], y[arity], z[arity], r[arity];
    uint present[arity];
    for (int i = 0; i < int(arity); ++i) {
        x[i] = frame.x + frame.w * float(int(codes[i].x & 0xffffu)) - view.position.x;
        y[i] = frame.y + frame.w * float(int(codes[i].x >> 16)) - view.position.y;
        z[i] = frame.z + frame.w * float(int(codes[i].y & 0xffffu)) - view.position.z;
        r[i] = uintBitsToFloat((codes[i].y >> 16) << 15);
        present[i] = (codes[i].y >> 16) == bsh_absent ? 0u : ~0u;
    }
    const vec3 n = view.direction;
    const bool cone = view.cos_phi != 0;
    const uint height = bsh_height(arity * block, {tree.leaves, tree.blocks, uint(std::countr_zero(arity))});  // a constant's division is none
    uint outside[arity], small[arity];
    for (int i = 0; i < int(arity); ++i) {
        const float l2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        const float a = n.x * x[i] + n.y * y[i] + n.z * z[i];
        float distance = -a * view.sin_phi;
        if (cone) {
            const float off_x = x[i] - a * n.x, off_y = y[i] - a * n.y, off_z = z[i] - a * n.z;
            const float b = std::sqrt(off_x * off_x + off_y * off_y + off_z * off_z);
            const bool behind_apex = view.cos_phi > 0 && a * view.cos_phi + b * view.sin_phi < 0;
            distance = behind_apex ? std::sqrt(l2) : distance + b * view.cos_phi;
        }
        const float reach = std::fabs(x[i]) + std::fabs(y[i]) + std::fabs(z[i]) + 2 * r[i];
        outside[i] = distance > r[i] + float(height) * (cull_margin * reach) ? ~0u : 0u;
        const float tangent2 = l2 - r[i] * r[i];
        const float c = map_size * r[i] / (std::fabs(x[i]) + std::sqrt(std::max(tangent2, 0.0f)));
        small[i] = tangent2 > 0.0625f * l2 && c < epsilon ? ~0u : 0u;
    }
    const uint leaf = height == 0 ? ~0u : 0u;
    uint found = 0;
    for (int i = 0; i < int(arity); ++i) {
        const uint culled = present[i] & outside[i];
        const uint drawn = present[i] & ~outside[i] & (small[i] | leaf);
        const uint open = present[i] & ~outside[i] & ~(small[i] | leaf);
        found |= ((drawn & 0x1u) | (culled & 0x100u) | (open & 0x10000u)) << i;
    }
    return found;
}

uint children(const NativeTree& tree, uint block) {
    uint n = 0;
    for (uint i = 0; i < tree.arity(); ++i) n += !bsh_is_absent(tree.spheres[size_t(block) * tree.arity() + i]);
    return n;
}

uint root_of(const NativeTree& tree, const View& view, float epsilon, uint map_size) {
    return classify_child(view, tree.frames[tree.blocks], tree.spheres[tree.root()], bsh_height(tree.root(), tree), epsilon, map_size);
}

}  // namespace

bool native_available() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

uint64_t NativeCuts::node_views() const {
    uint64_t sum = 0;
    for (const Lists& l : lists_) sum += l.node_views;
    return sum;
}

uint64_t NativeCuts::bytes() const {
    uint64_t sum = 0;
    for (const Lists& l : lists_) sum += (l.items.capacity() + l.next.capacity() + l.kept.capacity()) * sizeof(uvec2);
    return sum;
}

// Runs work(lists, begin, end) over the views, a thread for each set of lists.
template <class Work>
void NativeCuts::parallel(size_t views, Work work) {
    std::vector<std::thread> pool;
    const size_t n = lists_.size();
    auto part = [&](size_t t) {
        lists_[t].kept.clear();
        lists_[t].node_views = 0;
        work(lists_[t], views * t / n, views * (t + 1) / n);
    };
    for (size_t t = 1; t < n; ++t) pool.emplace_back(part, t);
    part(0);
    for (std::thread& t : pool) t.join();
}

inline void NativeCuts::keep(Lists& out, uint block, uint view, uint found) {
    if (found & 0xffffu) out.kept.push_back(cut_pack(block, view, found & 0xffffu));
}

template <uint arity>
void NativeCuts::lists_of(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size) {
    const uint root_children = children(tree, tree.blocks - 1);
    parallel(views.size(), [&](Lists& out, size_t begin, size_t end) {
        out.next.clear();
        for (size_t v = begin; v < end; ++v) {
            const uint root = root_of(tree, views[v], epsilon, map_size);
            keep(out, tree.blocks, uint(v), root);
            if (root >> 16) out.next.push_back({tree.blocks - 1, uint(v)});
        }
        out.node_views += end - begin;
        for (uint work = root_children; !out.next.empty(); work = arity) {
            out.items.swap(out.next);
            out.next.clear();
            for (const uvec2& pair : out.items) {
                const uint found = open_block<arity>(tree, pair.x, views[pair.y], epsilon, float(map_size));
                keep(out, pair.x, pair.y, found);
                for (uint open = found >> 16; open; open &= open - 1)
                    out.next.push_back({arity * pair.x + uint(__builtin_ctz(open)) - tree.leaves, pair.y});
            }
            out.node_views += out.items.size() * work;
        }
    });
}

template <uint arity>
void NativeCuts::depth_first_of(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size) {
    const uint root_children = children(tree, tree.blocks - 1);
    parallel(views.size(), [&](Lists& out, size_t begin, size_t end) {
        for (size_t v = begin; v < end; ++v) {
            const View view = views[v];
            const uint root = root_of(tree, view, epsilon, map_size);
            ++out.node_views;
            keep(out, tree.blocks, uint(v), root);
            if (!(root >> 16)) continue;
            out.stack.assign(1, tree.blocks - 1);
            while (!out.stack.empty()) {
                const uint block = out.stack.back();
                out.stack.pop_back();
                const uint found = open_block<arity>(tree, block, view, epsilon, float(map_size));
                out.node_views += block == tree.blocks - 1 ? root_children : arity;
                keep(out, block, uint(v), found);
                for (uint open = found >> 16; open; open &= open - 1)
                    out.stack.push_back(arity * block + uint(__builtin_ctz(open)) - tree.leaves);
            }
        }
    });
}

void NativeCuts::lists(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size) {
    if (tree.arity() == 2) lists_of<2>(tree, views, epsilon, map_size);
    else if (tree.arity() == 4) lists_of<4>(tree, views, epsilon, map_size);
    else lists_of<8>(tree, views, epsilon, map_size);
}

void NativeCuts::depth_first(const NativeTree& tree, const std::vector<View>& views, float epsilon, uint map_size) {
    if (tree.arity() == 2) depth_first_of<2>(tree, views, epsilon, map_size);
    else if (tree.arity() == 4) depth_first_of<4>(tree, views, epsilon, map_size);
    else depth_first_of<8>(tree, views, epsilon, map_size);
}

}  // namespace myriad::tools
