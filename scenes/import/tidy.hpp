// What every imported scene goes through, whatever it came from.
#pragma once

#include <glm/glm.hpp>

#include "scenes/import/import.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes {

// Turns axes so that `up` points along +Y. A rotation: nothing is mirrored.
glm::dmat4 upright(Axis up);

// Everything in the scene is turned by `rotation` and scaled by `scale`. Intensities stay: they are what a file says.
void transform(Scene& scene, const glm::dmat4& rotation, double scale);

// Puts a node of this matrix above all of scene.nodes, if there are any.
void add_root(Scene& scene, const glm::dmat4& matrix);

// Makes the scene sound, so that it can be written and rendered: leaves out triangles that have no area or a corner that
// is not finite, vertices and meshes and textures and materials that nothing uses; repairs normals, tangents, texture
// coordinates and colours that are not finite, and makes normals unit. What was defective is counted in scene.warnings.
// Primitives without normals get them: smooth over edges that turn by less than `crease` degrees; 0 leaves them flat.
// Indices must be in range.
void tidy(Scene& scene, float crease);

// The normals of a primitive that has none, smooth over edges that turn by less than `crease` degrees. Corners at one
// place count as one whether they are one vertex or not; a vertex that needs two normals becomes two.
void smooth_normals(Primitive& primitive, float crease);

// Makes one vertex of vertices that are the same to the bit in all they have, in the order of their first use by triangles.
void weld(Primitive& primitive);

}  // namespace myriad::scenes
