#include "passes/geometry/unshaded.hpp"

#include <gtest/gtest.h>

namespace myriad::passes {
namespace {

TEST(Unshaded, plain_scenes_are_silent) {
    scenes::Scene scene;
    scene.materials.resize(2);
    scene.materials[1].base_color_texture = {0};
    scene.meshes.push_back({"", {{.positions = {{0, 0, 0}}}}});
    EXPECT_EQ(unshaded(scene), "");
}

TEST(Unshaded, counts_everything_that_is_left_out) {
    scenes::Scene scene;
    scene.materials.resize(6);
    scene.materials[0].alpha = scenes::Material::Alpha::mask;
    scene.materials[1].alpha = scenes::Material::Alpha::blend;
    scene.materials[2].normal_texture = {0};
    scene.materials[3].base_color_texture = {.texture = 0, .set = 1};
    scene.materials[4].emissive_texture = {.texture = 0, .set = 0, .transform = {2, 0, 0, 1, 0, 0}};
    scene.materials[5].unlit = true;
    scene.meshes.push_back({"", {{.positions = {{0, 0, 0}}, .colors = {{1, 1, 1, 1}}}}});
    scene.background = glm::vec3(1);
    EXPECT_EQ(unshaded(scene), "not shaded yet: 2 materials with alpha (opaque here), 1 with a normal map (smooth here), 2 with transformed textures or a "
                               "second set of coordinates (as the first set says here), 1 unlit (lit here), 1 primitives with vertex colours (without "
                               "them here), the sky behind the scene (black here).");
}

// A transform that no texture uses changes nothing.
TEST(Unshaded, transforms_without_a_texture_do_not_count) {
    scenes::Scene scene;
    scene.materials.resize(1);
    scene.materials[0].base_color_texture.set = 1;
    EXPECT_EQ(unshaded(scene), "");
}

}  // namespace
}  // namespace myriad::passes
