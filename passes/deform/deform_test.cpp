// The kernel against scenes::deform, to the bit.
#include "passes/deform/deform.hpp"

#include <cstring>

#include "engine/testing.hpp"
#include "engine/transfer.hpp"
#include "passes/frame.hpp"
#include "passes/geometry/test_scene.hpp"

namespace myriad::passes {
namespace {

class DeformTest : public engine::DeviceTest {
protected:
    float uniform(float lo = -1, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(random); }
    vec3 point(float size = 1) { return size * vec3(uniform(), uniform(), uniform()); }

    // Triangles of which all but `still` move: with one influence, some, or none; with morph deltas or without; each third is flat.
    TestScene moving(uint32_t still, uint32_t moving, bool bends) {
        TestScene test;
        if (bends) test.textured(random);
        else test.material(vec3(0.5f));
        if (still + moving > 0) test.soup(still + moving, 2, random);
        test.decorate(random);
        scenes::Motion& motion = test.triangles.motion;
        motion.first_vertex = 3 * still, motion.first_triangle = still;
        motion.matrices.resize(9), motion.weights.resize(4);
        for (uint32_t i = 0; i <= 3 * moving; ++i) {
            motion.vertices.push_back({point(2), glm::normalize(point() + vec3(0, 0.1f, 0)), uint(motion.influences.size()), uint(motion.deltas.size())});
            if (i == 3 * moving) break;
            motion.tangents.emplace_back(i % 5 ? glm::normalize(point() + vec3(0.1f, 0, 0)) : vec3(0), i % 2 ? 1 : -1);
            const uint32_t influences = i % 7 == 6 ? 0 : i % 3 ? 1 : 1 + random() % 8;
            for (uint32_t k = 0; k < influences; ++k) motion.influences.push_back({uint(random() % 9), influences == 1 ? 1 : 1 / float(influences) + 0.1f * uniform()});
            for (uint32_t k = random() % 4; k > 0; --k) motion.deltas.push_back({uint(random() % 4), point(0.5f), point(0.2f)});
            if (i % 9 == 0) motion.flat.push_back(i);
        }
        return test;
    }
    scenes::Moment moment(float size = 1) {
        scenes::Moment m;
        for (int i = 0; i < 9; ++i) m.matrices.push_back({size * point(), size * point(), (i == 3 ? 0 : 1) * size * point(), size * point()});  // 3: flat
        for (int i = 0; i < 4; ++i) m.weights.push_back(i == 1 ? 0 : uniform(-0.5f, 1.5f));
        return m;
    }

    template <class T>
    static size_t different(const std::vector<T>& a, const std::vector<T>& b) {
        size_t n = a.size() == b.size() ? 0 : a.size() + b.size();
        for (size_t i = 0; n == 0 && i < a.size(); ++i) n += std::memcmp(&a[i], &b[i], sizeof(T)) != 0;
        return n;
    }
};

TEST_F(DeformTest, equals_the_twin) {
    for (const auto& [still, count] : {std::pair{0u, 1u}, {5u, 21u}, {0u, 22u}, {100u, 1000u}})
        for (const bool bends : {false, true}) {
            TestScene test = moving(still, count, bends);
            const GeometryData data = geometry_data(test.scene, test.triangles);
            EXPECT_EQ(data.world.first_moving, still);
            const Geometry geometry(device, test.triangles, data);
            DeformPass pass(device, test.triangles.motion);
            EXPECT_EQ(pass.count(), 3 * count);
            for (const float size : {1.0f, 1.0f, 1e-6f, 1e6f, 1e12f}) {
                const scenes::Moment now = moment(size);
                EXPECT_TRUE(pass.differs(now));
                scenes::deform(test.triangles, now);
                engine::Recorder recorder(device);
                pass.record(recorder, geometry, now);
                recorder.submit_and_wait();
                EXPECT_FALSE(pass.differs(now));
                // Vertices that stand still are among them.
                EXPECT_EQ(different(engine::download(device, geometry.positions()), test.triangles.positions), 0u) << count << " " << size;
                EXPECT_EQ(different(engine::download(device, geometry.normals()), test.triangles.normals), 0u) << count << " " << size;
                if (bends) EXPECT_EQ(different(engine::download(device, geometry.tangents()), test.triangles.tangents), 0u) << count << " " << size;
                else EXPECT_EQ(geometry.tangents().count(), 0u);
                for (const vec3& p : test.triangles.positions) ASSERT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), scenes::farthest);
            }
        }
}

TEST_F(DeformTest, the_comparator_sees_one_weight) {
    TestScene test = moving(0, 30, false);
    const GeometryData data = geometry_data(test.scene, test.triangles);
    const Geometry geometry(device, test.triangles, data);
    DeformPass pass(device, test.triangles.motion);
    scenes::Moment now = moment();
    engine::Recorder recorder(device);
    pass.record(recorder, geometry, now);
    recorder.submit_and_wait();
    now.weights[2] += 1e-3f;
    EXPECT_TRUE(pass.differs(now));
    scenes::deform(test.triangles, now);
    EXPECT_GT(different(engine::download(device, geometry.positions()), test.triangles.positions), 0u);
}

// An emitter that moves shines by the area that it has; one that had none begins to.
TEST_F(DeformTest, emitters_shine_by_their_area) {
    TestScene test;
    const uint32_t lamp = test.material(vec3(0), vec3(1, 2, 3), true);
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lamp);   // stands still
    test.quad({0, 0, 1}, {1, 0, 0}, {0, 2, 0}, lamp);   // grows to four times its area
    test.quad({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, lamp);   // has none at first
    scenes::Motion& motion = test.triangles.motion;
    motion.first_vertex = 4, motion.first_triangle = 2;
    motion.matrices.resize(1), motion.weights.resize(1);
    for (uint32_t i = 0; i <= 8; ++i) {
        motion.vertices.push_back({i < 8 ? test.triangles.positions[4 + i] : vec3(0), {0, 0, 1}, i, i < 6 ? 0u : i == 6 ? 1u : 2u});
        if (i < 8) motion.influences.push_back({0, 1});
    }
    motion.deltas = {{0, {3, 0, 0}, vec3(0)}, {0, {3, 0, 0}, vec3(0)}};  // of the last quad's corners 1 and 2
    UploadedScene scene(device, test);
    ASSERT_EQ(scene.lights.count(), 6u);
    DeformPass pass(device, motion);
    scenes::Moment now;
    now.matrices = {{vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, 1), vec3(0)}}, now.weights = {1};
    engine::Recorder recorder(device);
    pass.record(recorder, scene.geometry, now);
    scene.lights.follow(recorder, scene.geometry);
    recorder.submit_and_wait();
    const std::vector<Light> lights = engine::download(device, scene.lights.array());
    const float areas[] = {1, 1, 8, 8, 12, 12};
    float before = 0;
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(lights[i].extent.x, areas[i]) << i;
        EXPECT_GT(lights[i].cdf, before) << "has no share: " << i;
        before = lights[i].cdf;
    }
}

// A punctual light that moves while an emitter stays where it has moved to leaves it its area: in the table, and through a frame.
TEST_F(DeformTest, emitters_keep_their_area_when_another_light_moves) {
    TestScene test;
    const uint32_t lamp = test.material(vec3(0), vec3(1, 2, 3), true), grey = test.material(vec3(0.5f));
    test.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
    test.quad({0, 0, 1}, {1, 0, 0}, {0, 2, 0}, lamp);  // grows to four times its area
    test.light(scenes::Light::Type::point, {0.5f, 0.5f, 0.5f}, {0, 0, -1}, vec3(1));
    test.look({0.5f, 0.5f, 5}, vec3(0.5f, 0.5f, 0));
    scenes::Motion& motion = test.triangles.motion;
    motion.first_vertex = 4, motion.first_triangle = 2;
    motion.matrices.resize(1), motion.weights.resize(1);
    for (uint32_t i = 0; i <= 4; ++i) {
        motion.vertices.push_back({i < 4 ? test.triangles.positions[4 + i] : vec3(0), {0, 0, 1}, i, 0});
        if (i < 4) motion.influences.push_back({0, 1});
    }
    scenes::Moment grown;
    grown.matrices = {{vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, 1), vec3(0)}}, grown.weights = {0}, grown.lights = test.scene.lights;
    scenes::Moment later = grown;
    later.lights[0].position.y = 0.25f;

    UploadedScene scene(device, test);
    ASSERT_EQ(scene.lights.count(), 3u);
    DeformPass pass(device, motion);
    engine::Recorder recorder(device);
    pass.record(recorder, scene.geometry, grown);
    for (const scenes::Moment* moment : {&grown, &later}) {
        scene.lights.move(moment->lights);
        scene.lights.follow(recorder, scene.geometry);
        recorder.submit_and_wait();
        const std::vector<Light> lights = engine::download(device, scene.lights.array());
        EXPECT_EQ(lights[0].position, moment->lights[0].position);
        EXPECT_EQ(lights[1].extent.x, 8);
        EXPECT_EQ(lights[2].extent.x, 8);
    }

    FrameSettings settings;
    settings.width = settings.height = 8, settings.vpls = 64, settings.bounces = 0, settings.subset = 0, settings.filter = false;
    settings.visibility = Visibility::none;
    const auto flux = [&](std::initializer_list<const scenes::Moment*> moments) {  // of all VPLs, on emitters alone, at the last of them
        Frame frame(device, test.scene, test.triangles, settings);
        for (const scenes::Moment* moment : moments) frame.move_to(*moment), frame.render(test.scene.cameras[0]);
        double sum = 0;
        for (const Vpl& v : engine::download(device, frame.vpls()->vpls(), engine::download(device, frame.vpls()->count())[0])) sum += double(v.flux.y);
        return sum;
    };
    const double at_once = flux({&later});
    EXPECT_GT(at_once, 0);
    EXPECT_NEAR(flux({&grown, &later}), at_once, 1e-6 * at_once);
}

}  // namespace
}  // namespace myriad::passes
