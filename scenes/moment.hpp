// A scene at a moment: what a frame needs of it, and the host's twin of the kernel that moves vertices.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace myriad::scenes {

// Every node at a moment. The same for the same seconds, whatever was asked before.
struct Pose {
    std::vector<glm::dmat4> worlds;            // one a node: from its space to the world
    std::vector<std::vector<float>> weights;   // one a node: of its mesh's morph targets
};
// `seconds` from the clips' beginnings, any finite number; without clips, at rest.
Pose pose_at(const Scene& scene, const Playback& playback, double seconds);

// What a frame takes to the device.
struct Moment {
    std::vector<Affine> matrices;   // Motion::matrices' values: a mesh's space to the world
    std::vector<float> weights;     // Motion::weights' values
    std::vector<Light> lights;      // all of Scene::lights, in that order, where they are now
    std::vector<Camera> cameras;    // all of Scene::cameras, likewise
};
// Throws InputError where a clip takes what moves to where nothing can be computed: not finite, or beyond `farthest`.
Moment moment_at(const Scene& scene, const Motion& motion, double seconds);

// Moves the moving vertices: positions, normals and tangents of `triangles`, whose motion this is the moment of. What a kernel
// computes, in the same order of roundings (deform.h).
void deform(Triangles& triangles, const Moment& moment);

// Moving vertex i, still in its mesh's space, and what takes it to the world.
struct MovedVertex {
    Affine matrix;
    glm::vec3 position, normal;
};
MovedVertex moved_vertex(const Motion& motion, const Moment& moment, uint32_t i);

// Whether a transform is one that a scene can be computed with: finite, in floats, and not beyond `farthest`.
bool sane(const glm::dmat4& to_world);

// Puts a camera or a light where its node is; false where the transform leaves no such thing, which changes nothing then.
// A camera has a place and looks along -Z, with its Y axis as far up as that leaves; scale does not concern it, but for one of 0.
bool place_camera(Camera& camera, const glm::dmat4& to_world);
// From `eye` to `target`; false where they are one, or `up` is the way from one to the other.
bool look(Camera& camera, const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);
bool place_light(Light& light, const glm::dmat4& to_world);

// Of scene.cameras, by a name or an index in decimal as pick_camera() takes them; empty: the first, or `none` when there is none.
// Throws InputError naming the cameras that exist.
uint32_t find_camera(const Scene& scene, const std::string& name);

// A clip by its name or its index in decimal; "all": every one. Throws InputError naming those that there are.
Playback pick_clips(const Scene& scene, const std::string& name, bool loop = true);

}  // namespace myriad::scenes
