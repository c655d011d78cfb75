// Whole frames, with what the cache gives and without: the same bits.
#include <filesystem>

#include "engine/testing.hpp"
#include "passes/frame.hpp"
#include "tools/temp_folder.hpp"

namespace myriad::tests {
namespace {

using FrameCache = engine::DeviceTest;

TEST_F(FrameCache, images_are_the_same_made_stored_and_found) {
    scenes::Scene scene = scenes::load("builtin:cornell");
    const scenes::Triangles triangles = scenes::flatten(scene);
    const auto render = [&](engine::Cache* cache, passes::Visibility visibility) {
        passes::FrameSettings s;
        s.width = 64, s.height = 48, s.vpls = 64, s.log2_samples = 12, s.visibility = visibility, s.cache = cache;
        passes::Frame frame(device, scene, triangles, s);
        frame.render(scene.cameras[0]);
        return engine::download(device, frame.beauty());
    };
    const tools::TempFolder folder;
    for (const passes::Visibility visibility : {passes::Visibility::manylods, passes::Visibility::rays}) {
        engine::Cache cache(folder / (visibility == passes::Visibility::rays ? "rays" : "maps"));
        const auto made = render(nullptr, visibility), stored = render(&cache, visibility);
        EXPECT_EQ(cache.found(), 0u);
        const auto found = render(&cache, visibility);
        EXPECT_EQ(cache.found(), cache.missing()) << "all that was stored";
        EXPECT_EQ(cache.found(), visibility == passes::Visibility::rays ? 1u : 2u) << "rays need no samples";
        EXPECT_TRUE(engine::same(made, stored));
        EXPECT_TRUE(engine::same(made, found));
    }
}

}  // namespace
}  // namespace myriad::tests
