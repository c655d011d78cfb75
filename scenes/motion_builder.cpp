#include "scenes/motion_builder.hpp"

#include <algorithm>
#include <cassert>

#include "engine/error.hpp"
#include "scenes/normals.hpp"

namespace myriad::scenes {
namespace {

// Whether its node places it as a whole: so too in a skinned mesh, where it has no joints.
bool rigid(const Primitive& primitive, const Instance& instance) { return instance.skin == none || primitive.joints[0].empty(); }

// Its normals, of unit length, with those repaired that are none.
std::vector<glm::vec3> sound_normals(const Primitive& primitive, size_t& repaired) {
    std::vector<glm::vec3> out;
    out.reserve(primitive.normals.size());
    for (const glm::vec3& n : primitive.normals) out.push_back(unit_or(glm::dvec3(n), glm::vec3(0)));
    repaired = repair_normals(out, primitive.positions, [&](auto face) {
        for (size_t t = 0; t + 2 < primitive.indices.size(); t += 3) face(primitive.indices[t], primitive.indices[t + 1], primitive.indices[t + 2]);
    });
    return out;
}

}  // namespace

MotionBuilder::MotionBuilder(const Scene& scene, const std::vector<Stance>& stances, Stance which, const Playback& playback)
    : scene_(scene), first_joint_(scene.instances.size(), none), node_matrix_(first_joint_), first_weight_(scene.instances.size(), none) {
    motion.playback = playback;
    std::vector<uint32_t> of_skin(scene.skins.size(), none);  // instances of one skin share its matrices
    for (size_t i = 0; i < stances.size(); ++i) {
        if (stances[i] != which) continue;
        const Instance& instance = scene.instances[i];
        if (instance.skin != none) {
            const Skin& skin = scene.skins[instance.skin];
            uint32_t& first = of_skin[instance.skin];
            if (first == none) {
                first = uint32_t(motion.matrices.size());
                for (size_t k = 0; k < skin.joints.size(); ++k) motion.matrices.push_back({skin.joints[k], glm::dmat4(skin.inverse_bind[k])});
            }
            first_joint_[i] = first;
        }
        const auto without_joints = [&](const Primitive& p) { return rigid(p, instance); };
        if (std::ranges::any_of(scene.meshes[instance.mesh].primitives, without_joints)) {
            node_matrix_[i] = uint32_t(motion.matrices.size());
            motion.matrices.push_back({instance.node});
        }
        first_weight_[i] = uint32_t(motion.weights.size());
        for (uint32_t k = 0; k < scene.nodes[instance.node].weights.size(); ++k) motion.weights.push_back({instance.node, k});
    }
    moment = moment_at(scene, motion, 0);
}

void MotionBuilder::finish() {
    if (motion.influences.size() >= none || motion.deltas.size() >= none)
        throw InputError(scene_.name + ": what moves has more than 2^32 joints' weights or morph deltas; give fewer instances or coarser meshes.");
    if (!motion.vertices.empty())
        motion.vertices.push_back({glm::vec3(0), glm::vec3(0), uint32_t(motion.influences.size()), uint32_t(motion.deltas.size())});
}

PosedPrimitive::PosedPrimitive(MotionBuilder& builder, uint32_t instance, const Primitive& primitive)
    : builder_(builder), tangents_(primitive.normals.empty() ? std::vector<glm::vec4>() : primitive.tangents) {
    for (glm::vec4& t : tangents_) t.w = t.w < 0 ? -1.0f : 1.0f;  // as of what stands still, whatever a file says
    const std::vector<glm::vec3> normals = sound_normals(primitive, bad_normals_);
    const size_t count = primitive.positions.size();
    own_.vertices.reserve(count + 1);
    at_.reserve(count);
    for (size_t i = 0; i <= count; ++i) {
        MovingVertex& v = own_.vertices.emplace_back();
        v.influences = uint32_t(own_.influences.size()), v.deltas = uint32_t(own_.deltas.size());
        if (i == count) break;
        v.position = primitive.positions[i];
        v.normal = normals.empty() ? glm::vec3(0) : normals[i];
        add_influences(primitive, instance, i);
        add_deltas(primitive, instance, i);
    }
    for (size_t i = 0; i < count; ++i) at_.push_back(moved_vertex(own_, builder.moment, uint32_t(i)));
}

void PosedPrimitive::add_influences(const Primitive& primitive, uint32_t instance, size_t i) {
    std::vector<Influence>& out = own_.influences;
    if (rigid(primitive, builder_.scene_.instances[instance])) return out.push_back({builder_.node_matrix_[instance], 1});
    const size_t first = out.size();
    for (int set = 0; set < 2; ++set)
        for (int k = 0; k < 4 && !primitive.joints[set].empty(); ++k)
            if (const float weight = primitive.joint_weights[set][i][k]; weight > 0) {
                assert(primitive.joints[set][i][k] < builder_.scene_.skins[builder_.scene_.instances[instance].skin].joints.size());
                out.push_back({builder_.first_joint_[instance] + primitive.joints[set][i][k], weight});
            }
    // The largest becomes what the others leave of 1: far from the origin every bit of the sum is seen.
    const auto largest = std::max_element(out.begin() + ptrdiff_t(first), out.end(), [](auto& a, auto& b) { return a.weight < b.weight; });
    if (largest == out.end()) return;
    double others = 0;
    for (auto it = out.begin() + ptrdiff_t(first); it != out.end(); ++it) others += it == largest ? 0 : double(it->weight);
    largest->weight = float(1 - others);
}

void PosedPrimitive::add_deltas(const Primitive& primitive, uint32_t instance, size_t i) {
    const uint32_t first = builder_.first_weight_[instance];
    const size_t weights = builder_.scene_.nodes[builder_.scene_.instances[instance].node].weights.size();
    for (uint32_t k = 0; k < std::min(primitive.targets.size(), weights); ++k) {
        const MorphTarget& target = primitive.targets[k];
        const glm::vec3 position = target.positions.empty() ? glm::vec3(0) : target.positions[i];
        const glm::vec3 normal = target.normals.empty() ? glm::vec3(0) : target.normals[i];
        if (position != glm::vec3(0) || normal != glm::vec3(0)) own_.deltas.push_back({first + k, position, normal});
    }
}

glm::vec3 PosedPrimitive::position(size_t i) const { return affine_point(at_[i].matrix, at_[i].position); }
glm::vec3 PosedPrimitive::normal(size_t i) const { return affine_normal(at_[i].matrix, at_[i].normal); }
glm::vec4 PosedPrimitive::tangent(size_t i) const { return affine_tangent(at_[i].matrix, tangents_[i]); }

void PosedPrimitive::keep(size_t i, bool usable) {
    Motion& motion = builder_.motion;
    MovingVertex v{.influences = uint32_t(motion.influences.size()), .deltas = uint32_t(motion.deltas.size())};
    if (usable) {
        const MovingVertex &from = own_.vertices[i], &next = own_.vertices[i + 1];
        v.position = from.position, v.normal = from.normal;
        motion.influences.insert(motion.influences.end(), own_.influences.begin() + from.influences, own_.influences.begin() + next.influences);
        motion.deltas.insert(motion.deltas.end(), own_.deltas.begin() + from.deltas, own_.deltas.begin() + next.deltas);
    }
    motion.vertices.push_back(v);
    if (builder_.with_tangents) motion.tangents.push_back(tangents_.empty() ? glm::vec4(0, 0, 0, 1) : tangents_[i]);
}

void PosedPrimitive::keep_flat() { builder_.motion.flat.push_back(uint32_t(builder_.motion.vertices.size())); }

}  // namespace myriad::scenes
