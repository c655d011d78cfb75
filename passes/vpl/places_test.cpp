// VPLs that stay themselves while lights and surfaces move.
#include <cstring>

#include "compute/manylods/manylods_io.h"
#include "engine/testing.hpp"
#include "passes/geometry/test_scene.hpp"
#include "passes/vpl/vpl.hpp"
#include "passes/vpl/vpl_ref.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;
using Type = scenes::Light::Type;

class PlacesTest : public engine::DeviceTest {
protected:
    struct Frame {
        std::vector<uint> count, owners, living;  // slots that live
        std::vector<Vpl> vpls, slots;
        std::vector<View> views;
    };
    Frame record(VplPass& pass, const UploadedScene& scene, uint32_t bounces, uint32_t seed = 1) {
        engine::Recorder recorder(device);
        pass.record(recorder, scene.geometry, scene.bvh, scene.lights, bounces, seed);
        recorder.submit_and_wait();
        EXPECT_EQ(engine::download(device, pass.exhausted())[0], 0u);
        const auto count = engine::download(device, pass.count()), alive = engine::download(device, pass.alive());
        Frame frame{count, engine::download(device, pass.owners(), count[0]), {}, engine::download(device, pass.vpls(), count[0]),
                    engine::download(device, pass.slots()), engine::download(device, pass.views(), count[0])};
        for (uint slot = 0; slot < alive.size(); ++slot)
            if (alive[slot]) frame.living.push_back(slot);
        return frame;
    }

    void prepare(VplPass& pass, const UploadedScene& scene, uint32_t bounces, uint32_t seed = 1) {
        engine::Recorder recorder(device);
        pass.prepare(recorder, scene.geometry, scene.bvh, scene.lights, bounces, seed);
    }

    // A court that the sun looks into, now from here, now from there; boxes stand in it.
    static TestScene court() {
        std::mt19937 random(5);
        TestScene test;
        test.room({-4, 0, -4}, {4, 3, 4}, test.material({0.7f, 0.6f, 0.5f}));
        test.triangles.triangles.resize(6);  // two walls and the floor
        test.soup(60, 2, random);
        return test;
    }
    static vec3 sun(float turn) { return {std::cos(turn), -1.2f, std::sin(turn)}; }
    void move(UploadedScene& scene, TestScene& test, size_t light, const vec3& direction) {
        test.scene.lights[light].direction = glm::normalize(direction);
        scene.lights.move(test.scene.lights);
    }
    static bool same(const Vpl& a, const Vpl& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
};

// Whatever happened before, the living are there, each in its place; places are the twin's.
TEST_F(PlacesTest, equal_the_twin_over_many_frames) {
    const vec3 from_below(0.1f, 1, 0.1f);
    for (uint32_t bounces : {1u, 3u})
        for (const bool prepared_for_less : {false, true}) {
            TestScene test = court();
            test.light(Type::directional, vec3(0), sun(0), vec3(1));
            test.light(Type::spot, {0, 2, 0}, {1, -1, 0}, vec3(2), 0.2f, 0.5f);
            UploadedScene scene(device, test);
            VplPass pass(device, 400, scene.bvh.constants());
            if (prepared_for_less) {  // most paths missed that scene, and there is no room for all that live in this one
                TestScene wall = test;
                wall.triangles.triangles.resize(1);
                const UploadedScene less(device, wall);
                prepare(pass, less, bounces);
            }
            PlacesRef twin{400};
            size_t died = 0, revived = 0, handed_on = 0, homeless = 0;
            std::vector<bool> lived;
            for (int frame = 0; frame < 24; ++frame) {
                const float turn = frame % 7 == 6 ? float(frame) : 0.05f * float(frame);
                move(scene, test, 1, {std::cos(turn), -1, std::sin(turn)});
                move(scene, test, 0, frame % 11 == 10 ? from_below : sun(turn));
                const Frame got = record(pass, scene, bounces);
                const std::vector<uint32_t> before = twin.owners;
                twin.step(got.living);
                ASSERT_EQ(got.owners, twin.owners) << "frame " << frame;
                ASSERT_EQ(got.count[1], uint(std::count(twin.alive.begin(), twin.alive.end(), true)));
                ASSERT_EQ(got.count[2], twin.homeless);
                for (size_t place = 0; place < got.owners.size(); ++place) {
                    ASSERT_TRUE(same(got.vpls[place], twin.alive[place] ? got.slots[got.owners[place]] : vpl_of_nothing())) << frame << ": " << place;
                    ASSERT_EQ(got.views[place].position, got.vpls[place].position);
                    if (place >= lived.size()) continue;
                    died += lived[place] && !twin.alive[place];
                    revived += !lived[place] && twin.alive[place];
                    handed_on += before[place] != twin.owners[place];
                }
                lived = twin.alive;
                homeless += twin.homeless;
            }
            EXPECT_GT(handed_on, 50u);
            EXPECT_TRUE(prepared_for_less || std::min(died, revived) > 100) << died << " " << revived;
            EXPECT_EQ(homeless > 0, prepared_for_less);
        }
}

// The sun moves by a degree a frame: nearly all VPLs move by little, and none is another's path's.
TEST_F(PlacesTest, move_little_where_the_light_does) {
    TestScene test = court();
    test.light(Type::directional, vec3(0), sun(0), vec3(1));
    UploadedScene scene(device, test);
    VplPass pass(device, 2000, scene.bvh.constants());
    prepare(pass, scene, 1);
    Frame last = record(pass, scene, 1);
    ASSERT_GT(last.vpls.size(), 1900u);
    for (int frame = 1; frame <= 10; ++frame) {
        move(scene, test, 0, sun(float(frame) * 0.0174533f));
        const Frame next = record(pass, scene, 1);
        size_t both = 0, near = 0, near_if_compacted = 0;  // alive in both frames
        for (size_t place = 0; place < last.vpls.size(); ++place) {
            if (last.vpls[place].flux == vec3(0) || next.vpls[place].flux == vec3(0)) continue;
            ++both;
            near += glm::distance(last.vpls[place].position, next.vpls[place].position) < 0.3f;
        }
        for (size_t i = 0; i < std::min(last.living.size(), next.living.size()); ++i)
            near_if_compacted += glm::distance(last.slots[last.living[i]].position, next.slots[next.living[i]].position) < 0.3f;
        EXPECT_GT(double(both), 0.97 * double(last.count[1])) << frame;
        EXPECT_GT(double(near), 0.85 * double(both)) << frame;
        EXPECT_LT(double(near_if_compacted), 0.5 * double(both)) << "what places are for";
        last = next;
    }
}

// The first frame is what it was before there were places: the living, in the order of slots.
TEST_F(PlacesTest, are_dense_and_in_order_at_first) {
    TestScene test = court();
    test.light(Type::directional, vec3(0), sun(0), vec3(1));
    const UploadedScene scene(device, test);
    VplPass pass(device, 1000, scene.bvh.constants());
    for (uint32_t bounces : {3u, 1u, 3u})
        for (uint32_t seed : {1u, 2u}) {
            const Frame first = record(pass, scene, bounces, seed), again = record(pass, scene, bounces, seed);
            EXPECT_EQ(first.owners, first.living);
            EXPECT_EQ(first.count[0], first.count[1]);
            EXPECT_TRUE(engine::same(first.owners, again.owners));
            EXPECT_EQ(std::memcmp(first.vpls.data(), again.vpls.data(), first.vpls.size() * sizeof(Vpl)), 0);
        }
}

TEST_F(PlacesTest, views_of_the_dead_see_nothing_and_they_light_nothing) {
    const View view = view_of_nothing();
    for (const float size : {1e-6f, 1.0f, 1e9f})
        for (const vec3& at : {vec3(0), vec3(1e9f), vec3(-1e9f, 1e9f, 0)}) {
            const Sphere all{at, 1.75f * size};
            EXPECT_EQ(classify(view, all, false, 1, 64), node_view_culled);
            EXPECT_EQ(classify(view, all, true, 1, 64), node_view_culled);
        }
    EXPECT_EQ(vpl_of_nothing().flux, vec3(0));
    EXPECT_EQ(unpack_direction(vpl_of_nothing().normal), view.direction);
}

// After lights moved, frames are those of a scene made so; a guide of before leaves sums of fluxes where they should be.
TEST_F(PlacesTest, light_moves_with_the_lights) {
    TestScene test = court();
    test.light(Type::directional, vec3(0), sun(0), vec3(1, 2, 3));
    test.light(Type::point, {0, 2, 0}, {0, 0, -1}, vec3(2));
    test.light(Type::spot, {3, 2.5f, 1}, {-1, -1, 0}, vec3(5), 0.1f, 0.4f);
    TestScene later = test;
    later.scene.lights[0].direction = glm::normalize(vec3(0.2f, -1, -0.6f));
    later.scene.lights[1].position = {1, 0.5f, -1};
    later.scene.lights[2].position = {-3, 2.5f, 1};
    later.scene.lights[2].direction = glm::normalize(vec3(1, -1, 0.2f));
    const UploadedScene made(device, later);
    const uint32_t seeds = 24;
    dvec3 sum[2] = {}, squares[2] = {};
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        UploadedScene moved(device, test);
        VplPass pass(device, 512, moved.bvh.constants()), other(device, 512, moved.bvh.constants());
        prepare(pass, moved, 1, seed);
        const auto before = record(pass, moved, 1, seed);
        moved.lights.move(later.scene.lights);
        const auto guided = record(pass, moved, 1, seed), plain = record(other, made, 1, seed);
        EXPECT_FALSE(same(before.vpls[0], guided.vpls[0]));
        int which = 0;
        for (const Frame* frame : {&guided, &plain}) {
            EXPECT_EQ(frame->count[2], 0u);
            dvec3 flux(0);
            for (const Vpl& v : frame->vpls) flux += dvec3(v.flux);
            sum[which] += flux, squares[which] += flux * flux;
            ++which;
        }
    }
    for (int c = 0; c < 3; ++c) {
        double mean[2], variance = 0;
        for (int g : {0, 1}) {
            mean[g] = sum[g][c] / seeds;
            variance += (squares[g][c] / seeds - mean[g] * mean[g]) / (seeds - 1);
        }
        EXPECT_LT(std::abs(mean[0] - mean[1]), 4 * std::sqrt(variance)) << mean[0] << " moved, " << mean[1] << " made";
        EXPECT_LT(std::sqrt(variance), 0.05 * mean[1]) << "says nothing";
    }

    // Two lamps of one power, by power alone: to the bit.
    TestScene lamps = court(), lamps_later = court();
    for (float x : {-1.0f, 1.0f}) {
        lamps.light(Type::point, {x, 2, 0}, {0, 0, -1}, vec3(2));
        lamps_later.light(Type::point, {x, 1, 1}, {0, 0, -1}, vec3(2));
    }
    UploadedScene moved(device, lamps);
    const UploadedScene other(device, lamps_later);
    moved.lights.move(lamps_later.scene.lights);
    VplPass one(device, 512, moved.bvh.constants()), two(device, 512, moved.bvh.constants());
    const Frame got = record(one, moved, 2), expected = record(two, other, 2);
    ASSERT_EQ(got.vpls.size(), expected.vpls.size());
    EXPECT_EQ(std::memcmp(got.vpls.data(), expected.vpls.data(), got.vpls.size() * sizeof(Vpl)), 0);
}

// The sun at the horizon of a plain brings nothing and has no share; at noon it must have one.
TEST_F(PlacesTest, a_light_that_comes_to_shine_gets_a_share) {
    TestScene test;
    test.quad({-3, 1, -2}, {0, 0, 4}, {6, 0, 0}, test.material(vec3(0.5f)));
    test.light(Type::point, {0, 2, 0}, {0, 0, -1}, vec3(1));
    test.light(Type::directional, vec3(0), {1, 0, 0}, vec3(2));
    for (const bool guided : {false, true}) {
        UploadedScene scene(device, test);
        VplPass pass(device, 2000, scene.bvh.constants());
        if (guided) prepare(pass, scene, 1);
        const auto flux = [&] {
            double sum = 0;
            const Frame frame = record(pass, scene, 1);
            for (uint slot : frame.living) sum += double(frame.slots[slot].flux.x);  // more of them than there is room for
            return sum;
        };
        TestScene noon = test;
        const double lamp = flux();
        move(scene, noon, 1, {0, -1, 0});
        EXPECT_NEAR(flux() - lamp, 0.5 * 2 * 24, 0.2) << guided;
    }
}

// Every S-th VPL still carries its share after the sun has gone a third of its way round.
TEST_F(PlacesTest, interleaved_sets_stay_fair) {
    TestScene test = court();
    test.light(Type::directional, vec3(0), sun(0), vec3(1));
    UploadedScene scene(device, test);
    VplPass pass(device, 4096, scene.bvh.constants());
    prepare(pass, scene, 2);
    Frame frame = record(pass, scene, 2);
    const auto deviation = [&](uint32_t sets, uint32_t bounce) {
        double total = 0, squares = 0;
        for (const Vpl& v : frame.vpls) total += v.bounce == bounce ? double(v.flux.x) : 0;
        for (uint32_t set = 0; set < sets; ++set) {
            double flux = 0;
            for (size_t i = set; i < frame.vpls.size(); i += sets) flux += frame.vpls[i].bounce == bounce ? double(frame.vpls[i].flux.x) : 0;
            const double off = flux * sets / total - 1;
            squares += off * off / sets;
        }
        return std::sqrt(squares);
    };
    for (int step = 0; step <= 120; ++step) {
        move(scene, test, 0, sun(float(step) * 0.0174533f));
        frame = record(pass, scene, 2);
        if (step % 60 != 0) continue;
        for (uint32_t sets : {4u, 16u, 64u})
            for (uint32_t bounce : {1u, 2u}) {
                // Independent choices would give the deviation that the fluxes themselves have.
                double own = 0, own_squares = 0;
                for (const Vpl& v : frame.vpls)
                    if (v.bounce == bounce) own += double(v.flux.x), own_squares += double(v.flux.x) * double(v.flux.x);
                EXPECT_LT(deviation(sets, bounce), std::sqrt(own_squares * sets) / own) << sets << " sets, bounce " << bounce;
            }
    }
}

}  // namespace
}  // namespace myriad::passes
