#include "scenes/moment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <glm/gtc/type_ptr.hpp>

#include "engine/error.hpp"

namespace myriad::scenes {
namespace {

std::optional<glm::dvec3> direction(const glm::dvec3& v) {
    const double length = glm::length(v);
    if (!(length > 0 && std::isfinite(length))) return {};
    return v / length;
}

// Where in a clip the moment is.
double local_time(const Clip& clip, bool loop, double seconds) {
    const double duration = clip.duration();
    if (!loop || duration <= 0) return seconds;
    const double rest = std::fmod(seconds, duration);
    return rest < 0 ? rest + duration : rest;
}

// What a clip makes of the nodes' own transforms and weights.
void play(const Clip& clip, double seconds, std::vector<Transform>& transforms, std::vector<std::vector<float>>& weights) {
    std::vector<double> values;
    for (const Channel& channel : clip.channels) {
        const Track& track = clip.tracks[channel.track];
        values.resize(std::max<size_t>(track.width, 4));
        sample(track, channel.path == Path::rotation, seconds, values.data());
        Transform& transform = transforms[channel.node];
        const glm::dvec3 v(values[0], values[1], values[2]);
        switch (channel.path) {
            case Path::translation: transform.translation = v; break;
            case Path::rotation: transform.rotation = glm::dquat(values[3], values[0], values[1], values[2]); break;
            case Path::scale: transform.scale = v; break;
            case Path::weights: {
                std::vector<float>& w = weights[channel.node];
                for (size_t i = 0; i < std::min<size_t>(w.size(), track.width); ++i) w[i] = float(values[i]);
            }
        }
    }
}

// Matrices beyond this, and weights beyond a million, would leave what floats can be computed with.
bool computable(const glm::dmat4& m) {
    return sane(m) && std::all_of(glm::value_ptr(m), glm::value_ptr(m) + 16, [](double x) { return std::abs(x) <= 1e18; });
}

Affine narrow(const glm::dmat4& m) { return {glm::vec3(m[0]), glm::vec3(m[1]), glm::vec3(m[2]), glm::vec3(m[3])}; }

}  // namespace

bool sane(const glm::dmat4& m) {
    const glm::mat4 narrow(m);
    const bool near = glm::all(glm::lessThanEqual(glm::abs(glm::vec3(narrow[3])), glm::vec3(farthest)));  // NaN is not
    return near && std::all_of(glm::value_ptr(narrow), glm::value_ptr(narrow) + 16, [](float x) { return std::isfinite(x); });
}

bool place_camera(Camera& camera, const glm::dmat4& to_world) {
    const auto back = direction(glm::dvec3(to_world[2]));
    const auto right = back ? direction(glm::cross(glm::dvec3(to_world[1]), *back)) : back;
    if (!right || !sane(to_world)) return false;
    camera.to_world = glm::mat4(glm::mat3(glm::dmat3(*right, glm::cross(*back, *right), *back)));
    camera.to_world[3] = to_world[3];
    return true;
}

bool look(Camera& camera, const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    glm::dmat4 to_world(1);
    to_world[2] = glm::dvec4(eye - target, 0);
    to_world[1] = glm::dvec4(up, 0);
    to_world[3] = glm::dvec4(eye, 1);
    return glm::length(eye - target) > 1e-9 && place_camera(camera, to_world);
}

bool place_light(Light& light, const glm::dmat4& to_world) {
    const auto along = direction(-glm::dvec3(to_world[2]));
    if (!sane(to_world) || (!along && light.type != Light::Type::point)) return false;
    light.position = glm::vec3(to_world[3]);
    if (along) light.direction = glm::vec3(*along);
    return true;
}

Pose pose_at(const Scene& scene, const Playback& playback, double seconds) {
    assert(std::isfinite(seconds));
    std::vector<Transform> transforms;
    Pose pose;
    transforms.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes) transforms.push_back(node.rest), pose.weights.push_back(node.weights);
    for (const uint32_t clip : playback.clips)
        play(scene.clips[clip], local_time(scene.clips[clip], playback.loop, seconds), transforms, pose.weights);
    pose.worlds.reserve(transforms.size());
    for (size_t i = 0; i < transforms.size(); ++i) {
        const Node& node = scene.nodes[i];
        const glm::dmat4 local = node.matrix ? *node.matrix : transforms[i].matrix();
        pose.worlds.push_back(node.parent == none ? local : pose.worlds[node.parent] * local);
    }
    return pose;
}

Moment moment_at(const Scene& scene, const Motion& motion, double seconds) {
    const Pose pose = pose_at(scene, motion.playback, seconds);
    Moment moment{.lights = scene.lights, .cameras = scene.cameras};
    moment.matrices.reserve(motion.matrices.size());
    for (const auto& [node, bind] : motion.matrices) {
        const glm::dmat4 matrix = pose.worlds[node] * bind;
        if (!computable(matrix))
            throw InputError(scene.name + ": at " + std::to_string(seconds) + " s node \"" + scene.nodes[node].name.substr(0, 100) +
                             "\" is beyond 1e9 m or its transform is not a sensible one; correct its animation, or leave it out.");
        moment.matrices.push_back(narrow(matrix));
    }
    moment.weights.reserve(motion.weights.size());
    for (const auto& [node, target] : motion.weights) moment.weights.push_back(std::clamp(pose.weights[node][target], -1e6f, 1e6f));
    // Where nothing of a light or a camera is left, it stays where it was at rest.
    for (Light& light : moment.lights)
        if (light.node != none) place_light(light, pose.worlds[light.node]);
    for (Camera& camera : moment.cameras)
        if (camera.node != none) place_camera(camera, pose.worlds[camera.node]);
    return moment;
}

MovedVertex moved_vertex(const Motion& motion, const Moment& moment, uint32_t i) {
    const MovingVertex &v = motion.vertices[i], &next = motion.vertices[i + 1];
    MovedVertex out{affine_zero(), v.position, v.normal};
    for (uint32_t k = v.deltas; k < next.deltas; ++k) {
        const MorphDelta& delta = motion.deltas[k];
        out.position += delta.position * moment.weights[delta.weight];
        out.normal += delta.normal * moment.weights[delta.weight];
    }
    for (uint32_t k = v.influences; k < next.influences; ++k)
        out.matrix = affine_add(out.matrix, moment.matrices[motion.influences[k].matrix], motion.influences[k].weight);
    return out;
}

void deform(Triangles& triangles, const Moment& moment) {
    const Motion& motion = triangles.motion;
    assert(moment.matrices.size() == motion.matrices.size() && moment.weights.size() == motion.weights.size());
    glm::vec3* positions = triangles.positions.data() + motion.first_vertex;
    glm::vec3* normals = triangles.normals.data() + motion.first_vertex;
    for (uint32_t i = 0; i < motion.count(); ++i) {
        const MovedVertex moved = moved_vertex(motion, moment, i);
        positions[i] = settled_point(affine_point(moved.matrix, moved.position));
        normals[i] = affine_normal(moved.matrix, moved.normal);
        if (!motion.tangents.empty()) triangles.tangents[motion.first_vertex + i] = affine_tangent(moved.matrix, motion.tangents[i]);
    }
    for (const uint32_t i : motion.flat)
        normals[i] = normals[i + 1] = normals[i + 2] = flat_normal(positions[i], positions[i + 1], positions[i + 2]);
}

Playback pick_clips(const Scene& scene, const std::string& name, bool loop) {
    Playback playback{.loop = loop};
    const auto& clips = scene.clips;
    for (uint32_t i = 0; i < clips.size() && playback.clips.empty(); ++i)
        if (clips[i].name == name) playback.clips = {i};
    const bool digits = !name.empty() && name.size() <= 9 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (playback.clips.empty() && digits && std::stoul(name) < clips.size()) playback.clips = {uint32_t(std::stoul(name))};
    if (playback.clips.empty() && name == "all")
        for (uint32_t i = 0; i < clips.size(); ++i) playback.clips.push_back(i);
    if (!playback.clips.empty()) return playback;
    if (clips.empty()) throw InputError(scene.name + ": there is no animation \"" + name + "\", for the scene has none; leave it out.");
    std::string known;
    for (size_t i = 0; i < std::min<size_t>(clips.size(), 100); ++i)
        known += (i ? ", " : "") + std::to_string(i) + " \"" + clips[i].name.substr(0, 100) + "\"";
    throw InputError(scene.name + ": there is no animation \"" + name + "\"; known: " + known + ", and all.");
}

}  // namespace myriad::scenes
