// A frame that is left in the middle, as the viewer leaves it when something else is wished for, is as if it had not been begun.
#include <limits>

#include "engine/testing.hpp"
#include "passes/frame.hpp"

namespace myriad::passes {
namespace {

struct Left {};

class interrupted_frame : public engine::DeviceTest {
protected:
    std::vector<vec4> image(Frame& frame, const scenes::Camera& camera) {
        frame.render(camera);
        return engine::download(device, frame.beauty());
    }
};

TEST_F(interrupted_frame, leaves_no_trace) {
    scenes::Scene scene = scenes::load("builtin:cornell");
    const scenes::Triangles triangles = scenes::flatten(scene);
    const scenes::Camera camera = scenes::pick_camera(scene, triangles, "");
    for (const Visibility visibility : {Visibility::manylods, Visibility::megaviews, Visibility::rays})
        for (const CutUpdate update : {CutUpdate::basic, CutUpdate::incremental}) {
            if (visibility == Visibility::megaviews && update != CutUpdate::basic) continue;
            FrameSettings settings;
            settings.width = 40, settings.height = 30, settings.vpls = 64, settings.subset = 16, settings.log2_samples = 12;
            settings.visibility = visibility, settings.maps.update = update;
            const std::vector<vec4> whole = image(*std::make_unique<Frame>(device, scene, triangles, settings), camera);

            int left = std::numeric_limits<int>::max(), called = 0;
            settings.maps.views_at_once = 16;
            settings.progress = [&](const std::string&, double) {
                ++called;
                if (left-- == 0) throw Left();
            };
            Frame frame(device, scene, triangles, settings);
            EXPECT_TRUE(engine::same(whole, image(frame, camera))) << "batches change no bit";
            called = 0;
            EXPECT_TRUE(engine::same(whole, image(frame, camera))) << "nor does another render, whose lists are long enough";
            const int pauses = called;
            EXPECT_GE(pauses, visibility == Visibility::rays ? 3 : 6);
            for (int at = 0; at < pauses; ++at) {
                left = at;
                EXPECT_THROW(frame.render(camera), Left) << at;
                left = std::numeric_limits<int>::max();
                EXPECT_TRUE(engine::same(whole, image(frame, camera))) << "left at " << at << " of " << pauses;
                EXPECT_LT(frame.times().size(), 60u) << "of one frame";
            }
        }
}

TEST_F(interrupted_frame, may_be_left_while_it_is_made) {
    scenes::Scene scene = scenes::load("builtin:cornell");
    const scenes::Triangles triangles = scenes::flatten(scene);
    FrameSettings settings;
    settings.width = 40, settings.height = 30, settings.vpls = 64, settings.log2_samples = 12;
    int left = 0, made = 0;
    settings.progress = [&](const std::string&, double) {
        if (left-- == 0) throw Left();
    };
    for (int at = 0; at < 12 && !made; ++at) {
        left = at;
        try {
            Frame frame(device, scene, triangles, settings);
            ++made;
        } catch (const Left&) {
        }
    }
    EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace myriad::passes
