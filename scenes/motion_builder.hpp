// How flatten() places what is skinned, morphed or moved, and describes what moves.
#pragma once

#include "scenes/moment.hpp"
#include "scenes/stance.hpp"

namespace myriad::scenes {

// Matrices and morph weights of all instances of one stance, and the motion that comes of it.
class MotionBuilder {
public:
    MotionBuilder(const Scene& scene, const std::vector<Stance>& stances, Stance which, const Playback& playback);

    Motion motion;        // vertices are added by PosedPrimitive
    Moment moment;        // at second 0
    bool with_tangents = false;

    // Ends the motion's arrays.
    void finish();

private:
    friend class PosedPrimitive;
    const Scene& scene_;
    std::vector<uint32_t> first_joint_, node_matrix_, first_weight_;  // of each instance, in the motion; or none
};

// One primitive of one instance, posed at second 0.
class PosedPrimitive {
public:
    PosedPrimitive(MotionBuilder& builder, uint32_t instance, const Primitive& primitive);

    glm::vec3 position(size_t i) const;
    glm::vec3 normal(size_t i) const;
    glm::vec4 tangent(size_t i) const;
    bool mirrored(size_t i) const { return affine_determinant(at_[i].matrix) < 0; }
    size_t bad_normals() const { return bad_normals_; }  // that were zero or no numbers, and were computed anew

    // Vertex i becomes the motion's next one; at the origin for good where it is not usable.
    void keep(size_t i, bool usable);
    // The next three that are kept are a triangle without normals of its own.
    void keep_flat();

private:
    void add_influences(const Primitive& primitive, uint32_t instance, size_t i);
    void add_deltas(const Primitive& primitive, uint32_t instance, size_t i);

    MotionBuilder& builder_;
    Motion own_;                     // of this primitive's vertices alone
    std::vector<MovedVertex> at_;    // at second 0
    std::vector<glm::vec4> tangents_;
    size_t bad_normals_ = 0;
};

}  // namespace myriad::scenes
