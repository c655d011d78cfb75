// Trees over triangles that move: refitted in part, measured, built again.
#include "compute/bsh/bsh_ref.hpp"
#include "engine/testing.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {
namespace {

using engine::same;
using glm::uvec4, glm::vec3;

class BshMovingTest : public engine::DeviceTest {
protected:
    vec3 point(float size = 1) {
        std::uniform_real_distribution<float> unit(-1, 1);
        return size * vec3(unit(random), unit(random), unit(random));
    }
    struct Moving {
        std::vector<vec3> positions;
        std::vector<uvec4> triangles;
        WorldTriangles world(uint first) const {
            WorldTriangles w{positions, triangles};
            w.first_moving = first;
            return w;
        }
    };
    Moving soup(uint n) {
        Moving m;
        for (uint i = 0; i < n; ++i) {
            const vec3 p = point();
            for (uint k = 0; k < 3; ++k) m.positions.push_back(p + point(0.1f));
            m.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0});
        }
        return m;
    }
    enum class How { all, moving, anew };
    void refit(Bsh& bsh, const Moving& m, How how) {
        const auto positions = on_device(m.positions);
        const auto triangles = on_device(m.triangles);
        engine::Recorder recorder(device);
        if (how == How::all) bsh.refit(recorder, positions, triangles);
        if (how == How::moving) bsh.refit_moving(recorder, positions, triangles);
        if (how == How::anew) bsh.rebuild(recorder, positions, triangles);
        if (!bsh.empty()) bsh.measure(recorder);
        recorder.submit_and_wait();
    }
    std::string check(const Bsh& bsh, const Moving& m) {
        return bsh_check(bsh_download(device, bsh), {engine::download(device, bsh.samples()), m.positions, m.triangles, bsh.sample_radius(), bsh.sample_share()});
    }
    bool equal(const Bsh& a, const Bsh& b) {
        const BshArrays x = bsh_download(device, a), y = bsh_download(device, b);
        return same(x.frames, y.frames) && same(x.spheres, y.spheres) && same(x.cones, y.cones) && same(x.boxes, y.boxes);
    }
};

// To the bit the bounds of a whole refit, with fewer blocks visited.
TEST_F(BshMovingTest, a_refit_in_part_is_a_refit) {
    for (const uint32_t depth : {0u, 1u, 3u, 7u, 12u})
        for (const uint first : {0u, 250u, 299u, 300u}) {
            Moving m = soup(300);
            Bsh part(device, m.world(first), depth, 1), whole(device, m.world(~0u), depth, 1);
            EXPECT_EQ(whole.moving_blocks(), 0u);
            EXPECT_TRUE(first != 300 || part.moving_blocks() == 0);
            EXPECT_TRUE(first != 0 || part.moving_blocks() == part.blocks() + 1);
            EXPECT_TRUE(first != 250 || depth != 12 || part.moving_blocks() < part.blocks() / 2);
            refit(part, m, How::all);
            for (int frame = 0; frame < 4; ++frame) {
                for (size_t i = 3 * first; i < m.positions.size(); ++i)
                    m.positions[i] = frame == 3 ? vec3(1, 2, 3) : frame == 2 ? 1e6f * m.positions[i] : m.positions[i] + point(0.3f);
                refit(part, m, How::moving);
                refit(whole, m, How::all);
                EXPECT_TRUE(equal(part, whole)) << depth << " " << first << " " << frame;
                EXPECT_EQ(check(part, m), "") << depth << " " << first << " " << frame;
            }
        }
}

// A tree whose samples were scattered is loose, says so, and is tight again when it is built anew: as tight as one that was made so.
TEST_F(BshMovingTest, quality_falls_with_deformation_and_a_rebuild_restores_it) {
    Moving m = soup(4000);
    Bsh bsh(device, m.world(0), 12, 1);
    refit(bsh, m, How::all);
    const BshQuality fresh = bsh.quality();
    EXPECT_GT(fresh.extent, 0);
    EXPECT_GT(fresh.overlap, 0.2);
    // In a small motion little changes, in a rigid one nothing but roundings.
    Moving turned = m;
    for (vec3& p : turned.positions) p = vec3(p.z, p.y, -p.x);
    refit(bsh, turned, How::moving);
    EXPECT_NEAR(bsh.quality().extent / fresh.extent, 1, 0.01);
    for (size_t i = 0; i < m.positions.size(); i += 3) {
        const vec3 by = point(0.5f);
        for (size_t k = i; k < i + 3; ++k) m.positions[k] += by;
    }
    refit(bsh, m, How::moving);
    const BshQuality torn = bsh.quality();
    EXPECT_GT(torn.extent, 3 * fresh.extent);
    EXPECT_EQ(check(bsh, m), "");
    EXPECT_EQ(bsh.rebuilds(), 0u);

    refit(bsh, m, How::anew);
    EXPECT_EQ(bsh.rebuilds(), 1u);
    EXPECT_EQ(check(bsh, m), "");
    Bsh made(device, m.world(0), 12, 1);
    refit(made, m, How::all);
    EXPECT_NEAR(bsh.quality().extent / made.quality().extent, 1, 0.05);
    EXPECT_NEAR(bsh.quality().overlap / made.quality().overlap, 1, 0.05);
    // And it goes on.
    for (vec3& p : m.positions) p += point(0.01f);
    refit(bsh, m, How::moving);
    EXPECT_EQ(check(bsh, m), "");
}

// The measure against its definition.
TEST_F(BshMovingTest, quality_is_what_it_says) {
    const Moving m = soup(500);
    for (const uint32_t depth : {3u, 8u, 10u}) {
        Bsh bsh(device, m.world(0), depth, 1);
        refit(bsh, m, How::all);
        const BshArrays tree = bsh_download(device, bsh);
        double overlap = 0, extent = 0;
        for (uint slot = tree.leaves; slot <= tree.root(); ++slot) {
            if (bsh_is_absent(tree.spheres[slot])) continue;
            const double own = double(tree.sphere(slot).radius);
            extent += own * own;
            const uint block = bsh_block_of(slot, tree);
            for (uint child = 8 * block; child < 8 * block + 8; ++child)
                if (!bsh_is_absent(tree.spheres[child])) overlap += std::pow(double(tree.sphere(child).radius) / own, 3) / tree.blocks;
        }
        EXPECT_NEAR(bsh.quality().overlap / overlap, 1, 0.02) << depth;  // a decoded radius is up to 2^-8 larger
        EXPECT_NEAR(bsh.quality().extent / extent, 1, 0.02) << depth;
    }
}

}  // namespace
}  // namespace myriad::compute
