#include "tools/view/cameras.hpp"

#include <algorithm>

namespace myriad::tools::view {
namespace {

constexpr float steepest = 1.55f;  // radians; straight up and down have no right

// A direction, turned.
glm::vec3 turned(const glm::vec3& direction, float right, float up) {
    const glm::vec3 d = glm::normalize(direction);
    const float azimuth = std::atan2(d.x, -d.z) + right;
    const float elevation = std::clamp(std::asin(std::clamp(d.y, -1.0f, 1.0f)) + up, -steepest, steepest);
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)};
}

}  // namespace

Eye eye_of(const scenes::Camera& camera, const glm::vec3& middle) {
    const glm::vec3 eye(camera.to_world[3]), ahead = turned(-glm::vec3(camera.to_world[2]), 0, 0);
    const float distance = std::max(glm::dot(middle - eye, ahead), 0.25f * glm::length(middle - eye));
    return {eye, eye + ahead * std::max(distance, 1e-3f), std::clamp(glm::degrees(camera.yfov), 1.0f, 170.0f)};
}

void set_eye(Texts& texts, const Eye& eye) {
    texts.erase("--camera");
    texts["--eye"] = show_point(eye.eye), texts["--target"] = show_point(eye.target), texts["--yfov"] = show_number(eye.yfov);
}

void fly(Eye& eye, const glm::vec3& way) {
    const glm::vec3 ahead = glm::normalize(eye.target - eye.eye), right = glm::normalize(glm::cross(ahead, glm::vec3(0, 1, 0)));
    const glm::vec3 step = right * way.x + glm::vec3(0, way.y, 0) + ahead * way.z;
    eye.eye += step, eye.target += step;
}

void look(Eye& eye, float right, float up) {
    const glm::vec3 way = eye.target - eye.eye;
    eye.target = eye.eye + turned(way, right, up) * glm::length(way);
}

void orbit(Eye& eye, float right, float up) {
    const glm::vec3 way = eye.target - eye.eye;
    eye.eye = eye.target - turned(way, right, up) * glm::length(way);
}

void approach(Eye& eye, float factor) {
    const glm::vec3 way = eye.target - eye.eye;
    if (glm::length(way) * factor > 1e-3f) eye.eye = eye.target - way * factor;
}

}  // namespace myriad::tools::view
