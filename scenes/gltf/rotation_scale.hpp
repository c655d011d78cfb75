// A linear map taken apart into what a node of glTF can say: a rotation and a scale along its own axes.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace myriad::scenes::gltf {

// m = rotation(outer) * scale(scale) * rotation(inner), by singular values. Works for every finite m: a mirroring one has
// a negative scale, a singular one a scale of 0.
struct RotationScale {
    glm::dquat outer{1, 0, 0, 0};
    glm::dvec3 scale{1};
    glm::dquat inner{1, 0, 0, 0};
};

RotationScale rotation_scale(const glm::dmat3& m);

// Whether the columns of m stand at right angles and none is 0: then m is one rotation and one scale.
bool at_right_angles(const glm::dmat3& m);

// The rotation that takes -Z to `direction`, a unit vector: how a light of glTF is aimed.
glm::dquat aim(const glm::dvec3& direction);

}  // namespace myriad::scenes::gltf
