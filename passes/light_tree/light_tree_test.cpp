#include "passes/light_tree/light_tree.hpp"

#include "passes/gather/gather_testing.hpp"
#include "passes/light_tree/light_tree_ref.hpp"

namespace myriad::passes {
namespace {

class LightTreeTest : public GatherTest {
protected:
    HostLightTree build(const std::vector<Vpl>& lights, uint32_t capacity, float scale) {
        std::vector<Vpl> room = lights;
        room.resize(capacity, vpl({3, 3, 3}, {0, 1, 0}, vec3(5)));  // there, and not counted
        compute::ViewTree views(device, capacity);
        LightTree tree(device, capacity);
        const auto on = on_device(room);
        const auto seen = on_device(light_views(room));
        const auto count = on_device(std::vector<uint>{uint(lights.size())});
        engine::Recorder recorder(device);
        for (int again = 0; again < 2; ++again) {
            views.record(recorder, seen, count, vec3(-scale), vec3(scale));
            tree.record(recorder, views, on, count);
        }
        recorder.submit_and_wait();
        HostLightTree host{.views = compute::view_tree_download(device, views, uint32_t(lights.size())), .lights = engine::download(device, tree.lights(), lights.size()), .nodes = {}};
        host.nodes = engine::download(device, tree.nodes(), host.views.nodes.size());
        return host;
    }
    void check(const std::vector<Vpl>& lights, uint32_t capacity, float scale = 2) {
        const HostLightTree expected = light_tree_ref(lights, capacity, vec3(-scale), vec3(scale)), found = build(lights, capacity, scale);
        ASSERT_EQ(light_tree_violation(expected), "") << "twin";
        ASSERT_EQ(light_tree_violation(found), "");
        ASSERT_EQ(expected.nodes.size(), found.nodes.size());
        for (size_t i = 0; i < lights.size(); ++i) ASSERT_EQ(std::memcmp(&expected.nodes[i], &found.nodes[i], sizeof(LightNode)), 0) << i;
        for (size_t i = capacity; i < found.nodes.size(); ++i) {
            const LightNode &a = expected.nodes[i], &b = found.nodes[i];
            ASSERT_EQ(a.flux, b.flux) << i;
            ASSERT_EQ(a.children, b.children) << i;
        }
    }
};

TEST_F(LightTreeTest, equals_the_twin_at_sizes_around_its_own) {
    for (uint32_t n : {0, 1, 7, 8, 9, 63, 64, 65, 1000}) {
        SCOPED_TRACE(n);
        check(random_vpls(n), std::max(n, 1u));
        check(random_vpls(n), n + 70);
    }
}

TEST_F(LightTreeTest, hard_lights) {
    std::vector<Vpl> lights = random_vpls(200);
    for (size_t i = 0; i < 200; i += 3) lights[i] = vpl_of_nothing();
    check(lights, 200);
    check(std::vector<Vpl>(100, vpl_of_nothing()), 100);
    check(std::vector<Vpl>(100, lights[1]), 100);                                   // one place
    for (Vpl& light : lights) light.flux = vec3(0);
    check(lights, 200);                                                             // dark
    lights = random_vpls(200);
    for (Vpl& light : lights) light.normal = pack_direction({0, 1, 0.01f * uniform()});
    check(lights, 200);                                                             // a narrow cone
    EXPECT_GT(build(lights, 200, 2).nodes[200].cos_spread, 0.99f);
    for (Vpl& light : lights) light.position = 1e6f * light.position;
    check(lights, 200, 2e6f);
}

TEST_F(LightTreeTest, the_check_finds_what_is_wrong) {
    std::vector<Vpl> lights = random_vpls(100);
    for (Vpl& light : lights) light.normal = pack_direction(normalize(vec3(0, 1, 0) + 0.2f * direction()));
    const HostLightTree good = light_tree_ref(lights, 100, vec3(-2), vec3(2));
    ASSERT_EQ(light_tree_violation(good), "");
    const auto finds = [&](const char* what, auto spoil) {
        HostLightTree bad = good;
        spoil(bad.nodes[100]);
        EXPECT_NE(light_tree_violation(bad).find(what), std::string::npos) << what << ": " << light_tree_violation(bad);
    };
    finds("sphere", [](LightNode& n) { n.radius *= 0.5f; });
    finds("cone", [](LightNode& n) { n.cos_spread = 0.9999f; });
    finds("flux", [](LightNode& n) { n.flux *= 1.001f; });
    finds("children", [](LightNode& n) { n.children += 16; });
}

}  // namespace
}  // namespace myriad::passes
