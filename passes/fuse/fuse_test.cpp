// Maps that views share, from the traversal to a map a view, against twins and against maps drawn view by view.
#include "passes/fuse/fuse.hpp"

#include <algorithm>

#include "compute/manylods/manylods_ref.hpp"
#include "compute/views/view_testing.hpp"
#include "engine/testing.hpp"
#include "passes/fuse/fuse_ref.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/maps/maps.hpp"
#include "passes/splat/splat_ref.hpp"

namespace myriad::passes {
namespace {

using compute::AppendLists, compute::AppendMode, compute::view;

class FuseTest : public engine::DeviceTest {
protected:
    static constexpr uint size = 16, texels = 2 * size * size;

    FuseTest() {
        scene.material(vec3(1));
        scene.room(vec3(-2), vec3(2), 0);
        scene.soup(40, 1, random);
        uploaded = std::make_unique<UploadedScene>(device, scene);
        tree = std::make_unique<compute::Bsh>(device, uploaded->data.world, 12, 1);
        engine::Recorder recorder(device);
        tree->refit(recorder, uploaded->geometry.positions(), uploaded->geometry.triangles(), nullptr, uploaded->geometry.opacity());
        recorder.submit_and_wait();
        host = compute::bsh_download(device, *tree);
    }
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float scale = 1) { return scale * vec3(uniform(), uniform(), uniform()); }
    // On the room's walls, as light paths' ends are, so many around one place.
    std::vector<View> clusters(size_t n, size_t each, float spread) {
        std::vector<View> views;
        vec3 middle(0), normal(0, 1, 0);
        for (size_t i = 0; i < n; ++i) {
            if (i % each == 0) {
                const int axis = int(random() % 3);
                middle = point(1.8f), normal = vec3(0), middle[axis] = random() % 2 ? 2.0f : -2.0f, normal[axis] = -middle[axis] / 2;
            }
            vec3 p = middle + point(spread);
            for (int a = 0; a < 3; ++a)
                if (normal[a] != 0) p[a] = middle[a];
            views.push_back({p, 0, normal, 1});
        }
        return views;
    }

    struct Outcome {
        std::vector<uint> atlas;      // the views' maps, in the tree's order
        compute::HostViewTree views;
        std::vector<uvec2> groups;
        compute::PairReport pairs;
        uint shared = 0;
        bool ok = false;
    };
    Outcome draw(const std::vector<View>& views, float epsilon, uint first = 0, uint limit = ~0u, uint shared_room = 4096) {
        const uint n = uint(views.size());
        limit = std::min(limit, n);
        SharedMaps shared(device, std::max(n, 1u), compute::bsh_constants(tree->arity()));
        std::vector<View> room = views;
        room.resize(std::max(n, 1u));
        const auto on = on_device(room);
        const auto count = on_device(std::vector<uint>{n});
        AppendLists lists(device, AppendMode::scan, 1 << 20, 1 << 20);
        engine::Array<uint> atlas(device, "test", "atlas", uint64_t(limit + shared_room) * texels);
        engine::Recorder recorder(device);
        shared.begin(recorder, on, count, vec3(-2), vec3(2));
        shared.record(recorder, lists, *tree, count, first, limit, epsilon, size, atlas, limit + shared_room);
        recorder.submit_and_wait();
        Outcome out;
        out.ok = lists.report().ok();
        out.atlas = engine::download(device, atlas, uint64_t(limit) * texels);
        out.views = compute::view_tree_download(device, shared.tree(), n);
        out.groups = engine::download(device, lists.kept(), lists.report().kept);
        out.pairs = shared.pairs();
        out.shared = shared.shared_needed();
        return out;
    }
    std::vector<uint> twin(const Outcome& found) const {
        std::vector<bool> has_map(found.views.nodes.size());
        for (const uvec2& code : found.groups) has_map[cut_unpack(code).view] = true;
        return fuse_ref(found.views, splat_ref(host, found.groups, found.views.nodes, 0, uint(found.views.nodes.size()), size), has_map, size);
    }
    // Texels that are nothing in one and not in the other, or differ by more than `tolerance` of the depth; of all.
    static double differing(const std::vector<uint>& a, const std::vector<uint>& b, float tolerance) {
        size_t differ = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            const float x = uintBitsToFloat(a[i]), y = uintBitsToFloat(b[i]);
            differ += std::isinf(x) != std::isinf(y) || (!std::isinf(x) && std::abs(x - y) > tolerance * x);
        }
        return double(differ) / double(std::max<size_t>(a.size(), 1));
    }

    TestScene scene;
    std::unique_ptr<UploadedScene> uploaded;
    std::unique_ptr<compute::Bsh> tree;
    compute::BshArrays host;
};

TEST_F(FuseTest, equals_the_twin) {
    for (const auto& [n, each, spread] : {std::tuple{0u, 1u, 0.f}, {1u, 1u, 0.f}, {9u, 9u, 0.01f}, {120u, 40u, 0.003f}, {60u, 60u, 0.0f}}) {
        SCOPED_TRACE(n);
        const Outcome found = draw(clusters(n, each, spread), 2);
        ASSERT_TRUE(found.ok);
        const auto expected = twin(found);
        ASSERT_EQ(found.atlas.size(), expected.size());
        EXPECT_EQ(differing(expected, found.atlas, 1e-5f), 0);
        if (n == 120) { EXPECT_GT(found.shared, 10u) << "not a test"; }
    }
    std::vector<View> with_dead = clusters(40, 20, 0.003f);
    with_dead[3] = with_dead[30] = view_of_nothing();
    const Outcome found = draw(with_dead, 2);
    EXPECT_EQ(differing(twin(found), found.atlas, 1e-5f), 0);
}

// A part of the views has the maps that it has in the whole, to the bit.
TEST_F(FuseTest, parts_are_parts_of_the_whole) {
    const auto views = clusters(150, 50, 0.01f);
    const Outcome whole = draw(views, 2);
    for (const auto& [first, limit] : {std::pair{0u, 64u}, {64u, 64u}, {128u, 22u}}) {
        const Outcome part = draw(views, 2, first, limit);
        EXPECT_TRUE(engine::same(std::vector<uint>(whole.atlas.begin() + first * texels, whole.atlas.begin() + (first + limit) * texels), part.atlas)) << first;
    }
}

// Sharing costs little: few texels show another surface than maps drawn view by view, with cuts of the same size, do. Those are at silhouettes, which move by up to
// half of epsilon; measured: 0.8 % at epsilon 1, 4.4 % at 2.
TEST_F(FuseTest, shared_maps_are_nearly_those_of_each_view) {
    const auto views = clusters(200, 50, 0.01f);
    for (const float epsilon : {1.0f, 2.0f}) {
        const Outcome found = draw(views, epsilon);
        const double sharing = double(found.pairs.total.shared) / double(found.pairs.total.rendered);
        EXPECT_GT(sharing, 2);
        const compute::HostTree cut_tree(device, *tree);
        const std::vector<View> sorted(found.views.nodes.begin(), found.views.nodes.begin() + uint(views.size()));
        std::vector<uvec2> groups;
        for (const compute::NodeView& nv : compute::cut_ref(cut_tree, sorted, epsilon, size).cut)
            if (!nv.culled) groups.push_back(cut_pack(nv.slot / 8, nv.view, 1u << nv.slot % 8));
        const auto alone = splat_ref(host, groups, sorted, 0, uint(sorted.size()), size);
        const double share = differing(alone, found.atlas, 0.05f);
        RecordProperty("differing_at_epsilon_" + std::to_string(int(epsilon)), std::to_string(share));
        EXPECT_LT(share, 0.02 * epsilon * epsilon);
        EXPECT_GT(share, 0) << "nothing was shared";
    }
}

TEST_F(FuseTest, too_few_maps_are_told) {
    const auto views = clusters(120, 40, 0.003f);
    const Outcome ample = draw(views, 2);
    const Outcome scarce = draw(views, 2, 0, ~0u, ample.shared - 1);
    EXPECT_FALSE(scarce.ok);
    EXPECT_EQ(scarce.shared, ample.shared);
    EXPECT_TRUE(std::ranges::all_of(scarce.atlas, [](uint depth) { return depth == atlas_nothing; })) << "nothing may be drawn";
    EXPECT_TRUE(engine::same(ample.atlas, draw(views, 2, 0, ~0u, ample.shared).atlas));
}

// Views that share more maps than ViewMaps has room for: they are done again with room enough, and then are right.
TEST_F(FuseTest, maps_grow_to_what_is_shared) {
    const auto views = clusters(120, 40, 0.003f);
    const uint n = uint(views.size());
    const auto on = on_device(views);
    const auto count = on_device(std::vector<uint>{n});
    ViewMaps maps(device, {.map_size = size, .epsilon = 2, .method = MapMethod::megaviews, .shared_maps = 2}, n, 1);
    const MapScene map_scene{.tree = tree.get(), .low = vec3(-2), .high = vec3(2)};
    engine::Recorder recorder(device);
    maps.begin(recorder, map_scene, on, count);
    uint tries = 0;
    do {
        maps.record(recorder, map_scene, on, count, 0);
        recorder.submit_and_wait();
    } while (++tries < 5 && !maps.accept());
    ASSERT_EQ(maps.batch(), n);
    const Outcome ample = draw(views, 2);
    ASSERT_GT(ample.shared, 2u) << "not a test";
    EXPECT_GT(tries, 1u);
    EXPECT_LE(tries, 3u);
    EXPECT_TRUE(engine::same(ample.atlas, engine::download(device, maps.atlas(), uint64_t(n) * texels)));
}

// A map that is not fused with what its view shares, and the shared map that it names, hold what the fused map does, to the bit.
TEST_F(FuseTest, asking_shared_maps_finds_what_fused_maps_have) {
    std::vector<View> views = clusters(120, 40, 0.003f);
    views[7] = view_of_nothing();
    const uint n = uint(views.size());
    const auto on = on_device(views);
    const auto count = on_device(std::vector<uint>{n});
    const MapScene map_scene{.tree = tree.get(), .low = vec3(-2), .high = vec3(2)};
    engine::Recorder recorder(device);
    const auto atlas_of = [&](ViewMaps& maps, uint words) {
        maps.begin(recorder, map_scene, on, count);
        maps.record(recorder, map_scene, on, count, 0);
        recorder.submit_and_wait();
        EXPECT_TRUE(maps.accept());
        return engine::download(device, maps.atlas(), words);
    };
    ViewMaps whole(device, {.map_size = size, .epsilon = 2, .method = MapMethod::megaviews, .shared_maps = 200}, n, 1);
    ViewMaps parts(device, {.map_size = size, .epsilon = 2, .method = MapMethod::megaviews, .shared_maps = 200, .asks = true}, n, 1);
    EXPECT_EQ(whole.asked(), nullptr);
    const auto fused = atlas_of(whole, n * texels), apart = atlas_of(parts, (n + 200) * texels);
    const auto asked = engine::download(device, *parts.asked(), n);
    std::vector<uint> found(apart.begin(), apart.begin() + n * texels);
    for (uint i = 0; i < n; ++i)
        for (uint texel = 0; texel < texels && asked[i].first != fuse_no_map; ++texel) {
            const uint depth = apart[asked[i].first + texel];
            if (depth == atlas_nothing || asked[i].offset.x > 1e10f) continue;
            const vec3 w = unproject(texel / (size * size), texel_middle(texel % size, texel / size % size, size));
            found[i * texels + texel] = std::min(found[i * texels + texel], floatBitsToUint(fused_depth(asked[i].offset, w, uintBitsToFloat(depth))));
        }
    EXPECT_FALSE(engine::same(fused, std::vector<uint>(apart.begin(), apart.begin() + n * texels))) << "nothing is shared: not a test";
    EXPECT_EQ(differing(fused, found, 1e-5f), 0);
}

// By hand: a wall one metre before the node's middle, seen from a view that stands a tenth nearer.
TEST(FusedDepth, follows_the_view) {
    EXPECT_NEAR(fused_depth({0.1f, 0, 0}, {1, 0, 0}, 1), 0.9f, 1e-6f);
    EXPECT_NEAR(fused_depth({-0.1f, 0, 0}, {1, 0, 0}, 1), 1.1f, 1e-6f);
    EXPECT_NEAR(fused_depth({0, 3, 0}, {1, 0, 0}, 4), 5, 1e-6f);
    EXPECT_EQ(fused_depth(vec3(0), {0, 0, 1}, 7), 7);
}

}  // namespace
}  // namespace myriad::passes
