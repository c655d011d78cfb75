// The device against the path-traced reference, which shares no code with it: the same means, by standard errors of both.
#include <cmath>

#include "engine/testing.hpp"
#include "engine/transfer.hpp"
#include "passes/frame.hpp"
#include "tests/scene_kit.hpp"
#include "tools/reference/reference.hpp"

namespace myriad::tests {
namespace {

class ReferenceFrameTest : public engine::DeviceTest {
protected:
    static constexpr uint32_t width = 24, height = 18, block = 6, seeds = 6;
    static constexpr float bound = 2;  // 1/m^2, of the VPLs: without, their light has no variance to estimate errors by

    // Means of blocks of pixels, green.
    static std::vector<double> blocks(const std::function<double(size_t)>& green) {
        std::vector<double> means(width / block * (height / block), 0.0);
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) means[y / block * (width / block) + x / block] += green(y * width + x) / (block * block);
        return means;
    }

    // `compensate`: rays a pixel that give back what the bound cuts off; 0: paths are bounded as VPLs are.
    void expect_same(scenes::Scene& scene, const scenes::Camera& camera, uint32_t bounces, uint32_t samples, uint32_t vpls, uint32_t compensate = 0) {
        const scenes::Triangles triangles = scenes::flatten(scene, scenes::Sharing::never);
        reference::Settings rs{.width = width, .height = height, .bounces = bounces, .model = reference::Model::diffuse, .samples = samples};
        if (compensate == 0) rs.bound = bound;
        reference::Film film(width, height);
        reference::Reference(scene, scene.lights, triangles, camera, rs).add_to(film);
        const tools::Image image = film.image(false);
        const auto plane = [&](const char* name) { return [&values = image.find(name)->values](size_t i) { return double(values[i]); }; };
        const std::vector<double> wanted = blocks(plane("indirect.G")), variance = blocks(plane("variance.G"));

        std::vector<double> sum(wanted.size(), 0.0), squares(wanted.size(), 0.0);
        double totals = 0, total_squares = 0;
        for (uint32_t seed = 1; seed <= seeds; ++seed) {
            passes::FrameSettings s;
            s.width = width, s.height = height, s.vpls = vpls, s.bounces = bounces, s.seed = seed, s.subset = 0;
            s.visibility = passes::Visibility::rays, s.brdf = passes::Brdf::diffuse, s.vpl_bound = bound, s.compensate = compensate;
            passes::Frame frame(device, scene, triangles, s);
            frame.render(camera);
            const std::vector<vec4> indirect = engine::download(device, frame.indirect());
            const std::vector<double> got = blocks([&](size_t i) { return double(indirect[i].y); });
            double total = 0;
            for (size_t i = 0; i < got.size(); ++i) sum[i] += got[i], squares[i] += got[i] * got[i], total += got[i];
            totals += total, total_squares += total * total;
            if (seed > 1 || !frame.direct()) continue;
            // Without chance: the same light at the same points, but where a shadow's edge runs through a pixel's middle.
            const std::vector<vec4> direct = engine::download(device, *frame.direct());
            size_t off = 0;
            for (size_t i = 0; i < direct.size(); ++i) {
                const double d = double(image.find("direct.G")->values[i]);
                off += std::abs(double(direct[i].y) - d) > 1e-3 * d + 1e-6;
            }
            EXPECT_LE(off, direct.size() / 100);
        }
        double chi = 0, all_wanted = 0, all_variance = 0;
        for (size_t i = 0; i < sum.size(); ++i) {
            const double mean = sum[i] / seeds, of_mean = std::max(0.0, squares[i] / seeds - mean * mean) / (seeds - 1);
            const double error = std::sqrt(of_mean + variance[i] / (block * block) + 1e-16);
            const double z = (mean - wanted[i]) / error;
            EXPECT_LT(std::abs(z), 6) << "block " << i << ": " << mean << ", not " << wanted[i] << " +- " << error;
            chi += z * z, all_wanted += wanted[i], all_variance += variance[i] / (block * block);
        }
        EXPECT_LT(std::sqrt(chi / double(sum.size())), 1.7);
        const double all = totals / seeds, error = std::sqrt(std::max(0.0, total_squares / seeds - all * all) / (seeds - 1) + all_variance);
        EXPECT_NEAR(all, all_wanted, 4 * error);
        EXPECT_LT(error, 0.03 * all_wanted);  // there is something to compare, and it would show
    }
};

// Off the middle: there, edges of the box run through the middles of pixels, and either side is right.
TEST_F(ReferenceFrameTest, emitters_and_two_bounces) {
    scenes::Scene scene = scenes::load("builtin:cornell");
    Kit kit;
    kit.look({0.31f, 2.6f, 9.7f}, {0.13f, 2.5f, 0});
    expect_same(scene, kit.scene.cameras[0], 2, 512, 1024);
}

TEST_F(ReferenceFrameTest, sun_and_a_bounce) {
    scenes::Scene scene = scenes::load("builtin:atrium?detail=0.25");
    expect_same(scene, scene.cameras[0], 1, 512, 1024);
}

// What the bound cuts off is given back: paths without a bound.
TEST_F(ReferenceFrameTest, compensated_emitters_and_two_bounces) {
    scenes::Scene scene = scenes::load("builtin:cornell");
    Kit kit;
    kit.look({0.31f, 2.6f, 9.7f}, {0.13f, 2.5f, 0});
    expect_same(scene, kit.scene.cameras[0], 2, 512, 1024, 16);
}

TEST_F(ReferenceFrameTest, compensated_sun_and_a_bounce) {
    scenes::Scene scene = scenes::load("builtin:atrium?detail=0.25");
    expect_same(scene, scene.cameras[0], 1, 512, 1024, 16);
}

}  // namespace
}  // namespace myriad::tests
