// Moving vertices at a moment: skins, morph targets and rigid parts, all alike; see README.md.
#pragma once

#include "passes/deform/deform_io.h"
#include "passes/geometry/geometry.hpp"
#include "scenes/moment.hpp"

namespace myriad::passes {

class DeformPass {
public:
    static bool needed(const scenes::Triangles& triangles) { return triangles.motion.count() > 0; }
    // Of the triangles that the geometry was made of; something of them moves.
    DeformPass(engine::Device& device, const scenes::Motion& motion);

    // Whether vertices are elsewhere than where they were put last.
    bool differs(const scenes::Moment& moment) const;

    // Puts moving vertices of the geometry where they are at a moment of that motion. Once a submission.
    void record(engine::Recorder& recorder, const Geometry& geometry, const scenes::Moment& moment);

    uint32_t count() const { return uint32_t(vertices_.count()) - 1; }  // of moving vertices

private:
    engine::Program deform_, flat_;
    uint32_t first_vertex_;
    bool placed_ = false;
    engine::Array<MovingVertex> vertices_;
    engine::Array<Influence> influences_;
    engine::Array<MorphDelta> deltas_;
    engine::Array<vec4> tangents_;
    engine::Array<uint> flat_triangles_;
    engine::Array<Affine> matrices_, host_matrices_;  // the host's are copied, for each is read by many vertices
    engine::Array<float> weights_, host_weights_;
};

}  // namespace myriad::passes
