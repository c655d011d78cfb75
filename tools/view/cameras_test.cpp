#include "tools/view/cameras.hpp"

#include <gtest/gtest.h>

#include "scenes/moment.hpp"

namespace myriad::tools::view {
namespace {

void expect_near(const glm::vec3& a, const glm::vec3& b) { EXPECT_LT(glm::length(a - b), 1e-4f) << show_point(a) << " is not " << show_point(b); }

TEST(view_cameras, fly_along_their_own_directions) {
    Eye eye{{0, 0, 5}, {0, 0, 0}, 45};
    fly(eye, {1, 2, 3});
    expect_near(eye.eye, {1, 2, 2});
    expect_near(eye.target, {1, 2, -3});
    look(eye, glm::radians(90.0f), 0);  // to the right, from -z to +x
    expect_near(eye.eye, {1, 2, 2});
    expect_near(eye.target, {6, 2, 2});
}

TEST(view_cameras, orbits_keep_target_and_distance) {
    Eye eye{{0, 0, 5}, {0, 1, 0}, 45};
    const float distance = glm::length(eye.eye - eye.target);
    for (int i = 0; i < 100; ++i) orbit(eye, 0.1f, 0.05f);
    expect_near(eye.target, {0, 1, 0});
    EXPECT_NEAR(glm::length(eye.eye - eye.target), distance, 1e-3f);
    EXPECT_LT(eye.eye.y, eye.target.y) << "it looks up from below";
    approach(eye, 0.5f);
    EXPECT_NEAR(glm::length(eye.eye - eye.target), distance / 2, 1e-3f);
    for (int i = 0; i < 1000; ++i) approach(eye, 0.5f);
    EXPECT_GT(glm::length(eye.eye - eye.target), 0.0f);
}

TEST(view_cameras, never_look_straight_up) {
    Eye eye{{0, 0, 5}, {0, 0, 0}, 45};
    for (int i = 0; i < 100; ++i) look(eye, 0, 0.3f);
    Texts texts;
    set_eye(texts, eye);
    EXPECT_NO_THROW(read("builtin:cornell", texts));
}

TEST(view_cameras, options_say_where_they_look) {
    const Eye eye{{0.1f, 1.7f, -3.25f}, {4, 2, 9}, 33.3f};
    Texts texts = {{"--camera", "front"}};
    set_eye(texts, eye);
    EXPECT_FALSE(texts.contains("--camera"));
    const scenes::Camera camera = looking(*read("builtin:cornell", texts));
    EXPECT_EQ(glm::vec3(camera.to_world[3]), eye.eye);
    EXPECT_FLOAT_EQ(camera.yfov, glm::radians(eye.yfov));
    expect_near(-glm::vec3(camera.to_world[2]), glm::normalize(eye.target - eye.eye));
    const Eye again = eye_of(camera, eye.target);
    expect_near(again.eye, eye.eye);
    expect_near(again.target, eye.target);
    EXPECT_FLOAT_EQ(again.yfov, eye.yfov);
}

}  // namespace
}  // namespace myriad::tools::view
