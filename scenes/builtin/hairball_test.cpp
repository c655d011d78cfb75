// The ball of hair: as many strands as asked for, each closed, all in the booth.
#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/builtin_kit.hpp"

namespace myriad::scenes {
namespace {

const Primitive& hair_of(const Scene& scene) { return scene.meshes.at(0).primitives.at(0); }

TEST(Hairball, EachStrandIsAClosedTube) {
    const Scene one = load("builtin:hairball?strands=1"), many = load("builtin:hairball?strands=40&thickness=1.5");
    EXPECT_EQ(hair_of(one).indices.size() / 3, 168u);
    EXPECT_EQ(hair_of(many).indices.size() / 3, 40 * 168u);
    EXPECT_EQ(open_edges(hair_of(many)), 0u);
    EXPECT_GT(signed_volume(hair_of(many)), 0);
}

TEST(Hairball, IsABallThatLiesOnThePaper) {
    const Scene scene = load("builtin:hairball");
    const Primitive& hair = hair_of(scene);
    EXPECT_GE(hair.indices.size() / 3, 500000u);
    EXPECT_LE(hair.indices.size() / 3, 1000000u);
    glm::vec3 lo(1e9f), hi(-1e9f);
    for (const glm::vec3& p : hair.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    EXPECT_GT(lo.y, 0);
    EXPECT_LT(lo.y, 0.05f);
    // A ball of radius 1 m around the middle of its height, from which a few strands stray, well short of the walls, 2.1 m away.
    const glm::vec3 middle(0, lo.y + 1, 0);
    size_t astray = 0;
    float farthest = 0;
    for (const glm::vec3& p : hair.positions) {
        farthest = std::max(farthest, glm::length(p - middle));
        astray += glm::length(p - middle) > 1.2f;
    }
    for (int axis : {0, 2}) EXPECT_TRUE(lo[axis] < -0.9f && hi[axis] > 0.9f) << axis;
    EXPECT_LT(farthest, 1.7f);
    EXPECT_LT(double(astray), 0.1 * double(hair.positions.size()));
}

TEST(Hairball, MoreStrandsAreThinner) {
    // The volume of hair stays nearly the same, so that the ball is about as dense to look at.
    const Scene few = load("builtin:hairball?strands=2000"), many = load("builtin:hairball?strands=8000");
    EXPECT_NEAR(signed_volume(hair_of(many)) / signed_volume(hair_of(few)), 1, 0.1);
    const Scene thick = load("builtin:hairball?strands=2000&thickness=2");
    EXPECT_NEAR(signed_volume(hair_of(thick)) / signed_volume(hair_of(few)), 4, 0.2);
}

TEST(Hairball, OptionsOutOfRangeAreRefused) {
    for (const char* source : {"builtin:hairball?strands=0", "builtin:hairball?strands=50001", "builtin:hairball?strands=many", "builtin:hairball?thickness=0", "builtin:hairball?hair=3"})
        EXPECT_THROW(load(source), InputError) << source;
}

TEST(Hairball, CamerasSeeFrontsOnly) {
    Scene scene = load("builtin:hairball?strands=2000");
    const Triangles triangles = flatten(scene, Sharing::never);
    ASSERT_EQ(scene.cameras.size(), 2u);
    for (const Camera& camera : scene.cameras) {
        const Seen seen = seen_from(scene, triangles, camera);
        EXPECT_EQ(seen.nothing, 0u) << camera.name;
        EXPECT_EQ(seen.backs, 0u) << camera.name;
    }
}

}  // namespace
}  // namespace myriad::scenes
