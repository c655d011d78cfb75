// What moves of a scene's triangles while clips play: the arrays that a device keeps, and how each frame's matrices are made.
//
// Made by flatten(). Moving triangles and their vertices are the *last* of Triangles: those before never change, so trees over
// them stay. Their number, order, materials, texture coordinates and colours stay too; positions, normals and tangents change.
// A mesh that moves, or is skinned or morphed, is never shared by instances: each is written out.
#pragma once

#include <vector>

#include "scenes/animation.hpp"
#include "scenes/deform.h"

namespace myriad::scenes {

// Which clips play. Where two move the same, the later one wins.
struct Playback {
    std::vector<uint32_t> clips;  // of Scene::clips; empty: the scene is at rest, and nothing moves
    bool loop = true;             // each clip from 0 to its own duration, again and again; else it stays at its end
};

// Matrix i of a frame is world(node) * bind, rounded to floats at the end.
struct MatrixSource {
    uint32_t node = none;
    glm::dmat4 bind{1};           // a joint's inverse bind matrix; the identity for a rigid part
};

// Morph weight i of a frame is weight `target` of the node.
struct WeightSource {
    uint32_t node = none, target = 0;
};

struct Motion {
    Playback playback;                     // also of lights and cameras; there can be no vertices and still be movement

    uint32_t first_vertex = 0;             // moving vertex i is vertex first_vertex + i of Triangles, up to its end,
    uint32_t first_triangle = 0;           // and triangles from here on are the moving ones

    // On the device as they are. With n moving vertices:
    std::vector<MovingVertex> vertices;    // n + 1: the last only says where influences and deltas end
    std::vector<glm::vec4> tangents;       // n where Triangles has tangents; else empty. In the mesh's space, w the bitangent's sign
    std::vector<Influence> influences;     // a vertex without any was no number, and is at the origin; no triangle uses it
    std::vector<MorphDelta> deltas;        // only those that are not 0; empty where nothing is morphed
    // Moving vertices i, i + 1 and i + 2 for each i here are a triangle without normals of its own: all three get flat_normal of
    // their places once these are known (their own `normal` is not looked at). A pass of its own; mostly empty.
    std::vector<uint32_t> flat;

    std::vector<MatrixSource> matrices;    // as many as Moment::matrices
    std::vector<WeightSource> weights;     // as many as Moment::weights

    uint32_t count() const { return vertices.empty() ? 0 : uint32_t(vertices.size()) - 1; }  // of moving vertices
    bool plays() const { return !playback.clips.empty(); }  // whether moments differ at all
};

}  // namespace myriad::scenes
