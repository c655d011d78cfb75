// Ways of cameras: keys, ends, what is refused.
#include "scenes/camera_path.hpp"

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include "scenes/refusal.hpp"

namespace myriad::scenes {
namespace {

class CameraPathTest : public testing::Test {
protected:
    std::string path = (std::filesystem::temp_directory_path() / ("myriad_path_" + std::to_string(::getpid()) + ".json")).string();
    void TearDown() override { std::filesystem::remove(path); }

    CameraPath read(const std::string& text) {
        std::ofstream(path) << text;
        return CameraPath(path);
    }
    static glm::vec3 eye(const Camera& c) { return glm::vec3(c.to_world[3]); }
    static glm::vec3 forward(const Camera& c) { return -glm::vec3(c.to_world[2]); }
};

void expect_near(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LE(glm::length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

const std::string square = R"("keys": [{"time": 0, "eye": [0, 0, 0], "target": [0, 0, -1]}, {"time": 1, "eye": [2, 0, 0], "target": [2, 0, -1]},
                                       {"time": 3, "eye": [2, 0, 4], "target": [2, 0, 3], "yfov": 60}])";

TEST_F(CameraPathTest, LinearIsStraight) {
    const CameraPath way = read(R"({"camera_path": 1, "interpolation": "linear", "yfov": 40, )" + square + "}");
    EXPECT_EQ(way.duration(), 3);
    expect_near(eye(way.at(0.25)), {0.5f, 0, 0});
    expect_near(eye(way.at(2)), {2, 0, 2});
    expect_near(forward(way.at(2)), {0, 0, -1});
    EXPECT_NEAR(way.at(0).yfov, glm::radians(40.0f), 1e-6);
    EXPECT_NEAR(way.at(2).yfov, glm::radians(50.0f), 1e-6);
}

TEST_F(CameraPathTest, SmoothMeetsItsKeysAndStandsAtItsEnds) {
    const CameraPath way = read(R"({"camera_path": 1, )" + square + "}");
    expect_near(eye(way.at(0)), {0, 0, 0});
    expect_near(eye(way.at(1)), {2, 0, 0});
    expect_near(eye(way.at(3)), {2, 0, 4});
    expect_near(eye(way.at(99)), {2, 0, 4});
    expect_near(eye(way.at(-1)), {0, 0, 0});
    // No corner: as fast just before a key as just after it.
    const double h = 1e-3;
    const glm::dvec3 before = glm::dvec3(eye(way.at(1))) - glm::dvec3(eye(way.at(1 - h))), after = glm::dvec3(eye(way.at(1 + h))) - glm::dvec3(eye(way.at(1)));
    EXPECT_LE(glm::length(before - after) / h, 1e-2);
}

TEST_F(CameraPathTest, WhatIsWrongIsToldWithItsPlace) {
    const auto refused = [&](const std::string& text) { return refusal(path, [&] { read(text); }); };
    EXPECT_NE(refused("{").find("damaged"), std::string::npos);
    EXPECT_NE(refused("{}").find("camera_path"), std::string::npos);
    EXPECT_NE(refused(R"({"camera_path": 1})").find("no keys"), std::string::npos);
    EXPECT_NE(refused(R"({"camera_path": 1, "keys": [{"time": 0, "eye": [0, 0, 0]}]})").find("keys[0]"), std::string::npos);
    EXPECT_NE(refused(R"({"camera_path": 1, "keys": [{"time": 0, "eye": [0, 0, 0], "target": [0, 0, 0]}]})").find("eye is at the target"), std::string::npos);
    EXPECT_NE(refused(R"({"camera_path": 1, "keys": [{"time": 0, "eye": [0, 9, 0], "target": [0, 0, 0]}]})").find("looks along"), std::string::npos);
    EXPECT_NE(refused(R"({"camera_path": 1, "keys": [{"time": 1, "eye": [0, 0, 1], "target": [0, 0, 0]}, {"time": 1, "eye": [0, 0, 1], "target": [0, 0, 0]}]})").find("not after"), std::string::npos);
    EXPECT_NE(refused(R"({"camera_path": 1, "speed": 3, "keys": []})").find("speed"), std::string::npos);
}

}  // namespace
}  // namespace myriad::scenes
