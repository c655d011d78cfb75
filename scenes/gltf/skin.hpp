// Skins, and what of each vertex follows which joint.
#pragma once

#include <array>

#include "scenes/gltf/nodes.hpp"

namespace myriad::scenes::gltf {

// JOINTS_n and WEIGHTS_n of a primitive, n = 0 and 1, as the file has them.
struct JointSet {
    std::vector<glm::vec4> joints, weights;
};
using JointSets = std::array<JointSet, 2>;
JointSets read_joint_sets(const Place& place, const tinygltf::Primitive& in);

// What was wrong with them, but harmless.
struct JointDefects {
    size_t sums = 0;   // vertices whose weights did not sum to 1, were negative or no numbers
    size_t sets = 0;   // primitives with sets beyond these two, which are left out
};
// Sets a primitive's joints, with weights that sum to 1.
void set_joints(const Place& place, const JointSets& sets, Primitive& out, JointDefects& defects);

// Fills scene.skins with those of scene.instances, whose `skin` is the file's number before and the scene's after. Needs
// scene.meshes.
void read_skins(const Place& place, const Hierarchy& hierarchy, Scene& scene);

}  // namespace myriad::scenes::gltf
