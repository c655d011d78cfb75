// Where the viewer looks from, and how keys and the mouse move it.
#pragma once

#include <glm/glm.hpp>

#include "scenes/scene.hpp"
#include "tools/view/wishes.hpp"

namespace myriad::tools::view {

struct Eye {
    glm::vec3 eye{0, 0, 5}, target{0};
    float yfov = default_yfov;  // degrees
};

// As a camera has it, at about as far as `middle` is.
Eye eye_of(const scenes::Camera& camera, const glm::vec3& middle);
// Its options, in place of any camera.
void set_eye(Texts& texts, const Eye& eye);

// All in the eye's own directions: right, up, ahead; metres.
void fly(Eye& eye, const glm::vec3& way);
// Radians to the right and up. Turns the eye's head; or carries the eye around the target.
void look(Eye& eye, float right, float up);
void orbit(Eye& eye, float right, float up);
// Times the distance to the target.
void approach(Eye& eye, float factor);

}  // namespace myriad::tools::view
