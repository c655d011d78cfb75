#include "passes/maps/maps.hpp"

#include <algorithm>
#include <limits>

#include "passes/gather/gather_testing.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

using compute::AppendMode;
using engine::same;

class MapsTest : public GatherTest {
protected:
    static constexpr uint32_t log2_samples = 12, width = 12, height = 9, block = 2;

    MapsTest() {
        scene.material(vec3(1));
        scene.room(vec3(-2), vec3(2), 0);
        scene.soup(60, 1, random);
        for (size_t i = 0; i < receivers.pixels(); ++i) receivers.put(i, point(1.9f), direction());
    }

    struct Outcome {
        std::vector<uint> atlas;       // of all views
        std::vector<vec4> irradiance;
        MapCounters counters;
        uint32_t batch = 0;            // at the end
        uint64_t bytes_before = 0;     // of everything but the maps
        std::string error;             // of OutOfMemory
    };
    // As the frame does it. `exist`: how many of the views there are.
    Outcome run(engine::Device& on, const std::vector<Vpl>& vpls, const MapSettings& settings, uint32_t exist = ~0u) {
        std::vector<View> views;
        for (const Vpl& v : vpls) views.push_back({v.position, 0, unpack_direction(v.normal), 1});
        const auto up = [&](const auto& values) { return engine::upload(on, "test", "test input", values); };
        const uint32_t n = uint32_t(vpls.size());
        const auto positions = up(scene.triangles.positions);
        const auto triangles = up(scene.triangles.triangles);
        const auto device_vpls = up(vpls);
        const auto device_views = up(views);
        const auto count = up(std::vector<uint>{std::min(exist, n)});
        const GBuffer gbuffer = receivers.on(on);
        compute::Bsh tree(on, world_triangles(scene.triangles), log2_samples, 1);
        GatherPass gather(on, GatherVisibility::maps, width, height);
        const uint64_t words = map_texels(settings.map_size);
        engine::Array<uint> all(on, "test", "all maps", n * words, engine::Location::host);
        engine::Array<vec4> light(on, "test", "light", gbuffer.pixels(), engine::Location::host);
        engine::Recorder recorder(on);
        tree.refit(recorder, positions, triangles);

        Outcome out;
        for (const auto& [kind, use] : on.memory()) out.bytes_before += use.now;
        try {
            ViewMaps maps(on, settings, n, block * block);
            gather.clear(recorder);
            for (uint32_t first = 0; first < n;) {
                EXPECT_EQ(maps.batch() % (block * block), 0u);
                const uint32_t batch = maps.batch();
                maps.record(recorder, {.tree = &tree}, device_views, count, first);
                gather.record_maps(recorder, {gbuffer, device_vpls, count, block, 5}, first, batch, &maps.atlas(), settings.map_size, 0.5f,
                                   maps.lists());
                recorder.copy(maps.atlas(), all, std::min(batch, n - first) * words * sizeof(uint), 0, first * words * sizeof(uint));
                recorder.submit_and_wait();
                if (maps.accept()) first += batch;
            }
            out.counters = maps.take_counters();
            out.batch = maps.batch();
        } catch (const OutOfMemory& e) {
            out.error = e.what();
            return out;
        }
        recorder.copy(gather.irradiance(), light, light.bytes());
        recorder.submit_and_wait();
        out.atlas.assign(all.span().begin(), all.span().end());
        out.irradiance.assign(light.span().begin(), light.span().end());
        return out;
    }

    static void expect_same(const Outcome& expected, const Outcome& got) {
        EXPECT_TRUE(same(expected.atlas, got.atlas));
        EXPECT_TRUE(same(expected.irradiance, got.irradiance));
        EXPECT_EQ(expected.counters.node_views, got.counters.node_views);
        EXPECT_EQ(expected.counters.cut, got.counters.cut);
        EXPECT_EQ(expected.counters.groups, got.counters.groups);
    }
    // A share of texels, so that images of nothing do not pass for equal.
    static double drawn(const Outcome& o) {
        return 1 - double(std::count(o.atlas.begin(), o.atlas.end(), floatBitsToUint(std::numeric_limits<float>::infinity()))) / double(o.atlas.size());
    }

    TestScene scene;
    HostGBuffer receivers{width, height};
};

TEST_F(MapsTest, both_append_modes_draw_the_same_atlas) {
    const auto vpls = random_vpls(41);
    const Outcome scan = run(device, vpls, {AppendMode::scan, 16, 1}), atomic = run(device, vpls, {AppendMode::atomic, 16, 1});
    EXPECT_GT(drawn(scan), 0.2);
    EXPECT_EQ(scan.counters.batches, 1u);
    expect_same(scan, atomic);
    expect_same(scan, run(device, vpls, {AppendMode::scan, 16, 1}));
}

// Cuts down to the leaves for tiny maps: the lists' first guess, which goes by texels, cannot suffice.
TEST_F(MapsTest, lists_grow_until_they_suffice) {
    const auto vpls = random_vpls(16);
    Outcome one_by_one;
    for (const Vpl& v : vpls) {
        const Outcome one = run(device, {v}, {AppendMode::scan, 2, 0.05f});
        EXPECT_EQ(one.counters.redone, 0u);
        one_by_one.atlas.insert(one_by_one.atlas.end(), one.atlas.begin(), one.atlas.end());
        one_by_one.counters.node_views += one.counters.node_views;
        one_by_one.counters.cut += one.counters.cut;
        one_by_one.counters.groups += one.counters.groups;
    }
    for (AppendMode mode : {AppendMode::scan, AppendMode::atomic}) {
        const Outcome all = run(device, vpls, {mode, 2, 0.05f});
        EXPECT_GT(all.counters.redone, 0u);
        EXPECT_EQ(all.counters.batches, 1u) << "there is memory for all";
        EXPECT_LE(all.counters.list_peak, all.counters.list_capacity);
        one_by_one.irradiance = all.irradiance;  // of all VPLs together; compared below
        expect_same(one_by_one, all);
    }
}

// From no memory at all to plenty: first an error that says so, then ever larger batches, always with the same bits.
TEST_F(MapsTest, the_memory_limit_changes_batches_and_nothing_else) {
    const auto vpls = random_vpls(48);
    for (const MapSettings& settings : {MapSettings{AppendMode::scan, 4, 0.05f}, {AppendMode::atomic, 16, 1}}) {
        const Outcome ample = run(device, vpls, settings);
        ASSERT_EQ(ample.error, "");
        uint32_t errors = 0, splits = 0, last_batch = 0;
        for (uint64_t extra : {16u << 10, 80u << 10, 140u << 10, 330u << 10, 4u << 20}) {
            SCOPED_TRACE(testing::Message() << extra << " bytes, map size " << settings.map_size);
            engine::Device small({.select = "", .validation = true, .memory_limit = ample.bytes_before + extra});
            const Outcome got = run(small, vpls, settings);
            EXPECT_EQ(small.validation_messages(), 0u);
            if (!got.error.empty()) {
                EXPECT_NE(got.error.find("--memory-limit"), std::string::npos) << got.error;
                EXPECT_EQ(last_batch, 0u) << "less memory sufficed";
                ++errors;
                continue;
            }
            expect_same(ample, got);
            EXPECT_GE(got.batch, last_batch);
            last_batch = got.batch;
            splits += got.counters.batches > 1;
            for (const auto& [kind, use] : small.memory()) EXPECT_LE(use.peak, small.memory_limit());
        }
        EXPECT_TRUE(errors > 0 && splits > 1 && last_batch == 48) << errors << " " << splits << " " << last_batch;
    }
}

// Frames in which views drift, jump, come and go or rest, and a part of the scene moves at times: the maps of cuts that are carried are those
// of basic cuts, in batches and with lists that grow. Maps that need not be drawn again are not, where one batch holds all.
TEST_F(MapsTest, carried_cuts_draw_what_basic_cuts_draw) {
    const uint32_t n = 40;
    auto vpls = random_vpls(n);
    compute::WorldTriangles world = world_triangles(scene.triangles);
    world.first_moving = uint(scene.triangles.triangles.size()) - 10;
    compute::Bsh tree(device, world, log2_samples, 1);
    auto points = scene.triangles.positions;
    const auto triangles = engine::upload(device, "test", "test input", scene.triangles.triangles);
    engine::Recorder recorder(device);
    {
        const auto positions = engine::upload(device, "test", "test input", points);
        tree.refit(recorder, positions, triangles);
        recorder.submit_and_wait();
    }
    MapSettings settings{AppendMode::scan, 16, 0.3f};
    ViewMaps basic(device, settings, n, 4);
    settings.update = CutUpdate::incremental;
    ViewMaps carried(device, settings, n, 4);
    settings.update = CutUpdate::lazy;
    settings.lazy_edges = 9;  // more than there are: complete
    ViewMaps lazy(device, settings, n, 4);
    uint64_t basic_views = 0, carried_views = 0, drawn = 0;
    for (int frame = 0; frame < 12; ++frame) {
        SCOPED_TRACE(frame);
        std::vector<View> views;
        for (Vpl& v : vpls) {
            if (frame && frame % 3 != 2 && random() % 3) v.position += 0.01f * direction();
            if (frame % 3 != 2 && random() % 20 == 0) v = random_vpls(1)[0];
            views.push_back({v.position, 0, unpack_direction(v.normal), 1});
        }
        if (frame > 6 && frame % 3 != 2) {
            for (uint t = world.first_moving; t < scene.triangles.triangles.size(); ++t) points[scene.triangles.triangles[t].x] += 0.02f * direction();
            const auto positions = engine::upload(device, "test", "test input", points);
            tree.refit_moving(recorder, positions, triangles);
            recorder.submit_and_wait();
        }
        const auto on = engine::upload(device, "test", "test input", views);
        const auto count = engine::upload(device, "test", "test input", std::vector<uint>{frame % 4 == 3 ? n - 7 : n});
        const auto draw = [&](ViewMaps& maps) {
            std::vector<uint> atlas;
            for (uint32_t first = 0; first < n;) {
                maps.record(recorder, {.tree = &tree}, on, count, first);
                recorder.submit_and_wait();
                if (!maps.accept()) continue;
                const auto part = engine::download(device, maps.atlas());
                atlas.insert(atlas.end(), part.begin(), part.end());
                first += maps.batch();
            }
            return atlas;
        };
        const std::vector<uint> expected = draw(basic);
        EXPECT_TRUE(same(expected, draw(carried)));
        EXPECT_TRUE(same(expected, draw(lazy)));
        const MapCounters b = basic.take_counters(), c = carried.take_counters();
        EXPECT_EQ(b.cut, c.cut);
        EXPECT_EQ(b.maps_drawn, std::nullopt);
        const uint64_t maps_drawn = *c.maps_drawn;
        EXPECT_TRUE(frame == 0 ? maps_drawn == n : frame == 5 ? maps_drawn == 0 : true) << "first all, and none at rest: " << maps_drawn;
        if (frame) basic_views += b.node_views, carried_views += c.node_views, drawn += maps_drawn;
    }
    EXPECT_LT(carried_views, basic_views / 2);
    EXPECT_LT(drawn, 11 * n * 2 / 3);
}

TEST_F(MapsTest, views_that_do_not_exist_see_nothing) {
    const auto vpls = random_vpls(9);
    const Outcome all = run(device, vpls, {AppendMode::scan, 8, 1});
    for (uint32_t exist : {0u, 1u, 5u}) {
        const Outcome some = run(device, vpls, {AppendMode::scan, 8, 1}, exist);
        for (size_t i = 0; i < some.atlas.size(); ++i)
            ASSERT_EQ(some.atlas[i], i / map_texels(8) < exist ? all.atlas[i] : floatBitsToUint(std::numeric_limits<float>::infinity())) << i;
    }
}

TEST_F(MapsTest, map_sizes_out_of_range_are_refused) {
    for (uint32_t size : {0u, 1u, 1025u, 65536u, ~0u}) {
        try {
            ViewMaps maps(device, {AppendMode::scan, size, 1}, 16, 4);
            ADD_FAILURE() << size;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("--map-size " + std::to_string(size)), std::string::npos) << e.what();
        }
    }
    EXPECT_NO_THROW(ViewMaps(device, {AppendMode::scan, 2, 1}, 16, 4));
}

TEST_F(MapsTest, comparator_sees_one_texel) {
    const auto vpls = random_vpls(4);
    const Outcome a = run(device, vpls, {AppendMode::scan, 8, 1});
    auto b = a.atlas;
    EXPECT_TRUE(same(a.atlas, b));
    b[77] -= 1;
    EXPECT_FALSE(same(a.atlas, b));
}

}  // namespace
}  // namespace myriad::passes
