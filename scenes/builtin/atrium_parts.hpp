// The pieces that the atrium is furnished with. Each is built around its own origin and says where that is; `detail`
// scales the tessellation.
#pragma once

#include "scenes/builtin/kit.hpp"

namespace myriad::scenes::atrium {

// The building and what is in it, without the sun and under a sky of this radiance.
Scene without_sun(float detail, uint32_t seed, glm::vec3 sky_radiance);

// Heights of the building that pieces must agree on, in metres.
inline constexpr float bay = 3.0f;             // from column axis to column axis
inline constexpr float gallery_floor = 0.12f;  // the lower gallery stands a step above the court
inline constexpr float lower_spring = 3.1f, upper_floor = 5.4f, upper_spring = 8.15f;
inline constexpr float wall_thickness = 0.5f;

using kit::steps;

// Standing on y = 0, `height` to the top of the abacus. The lower order is fluted, the upper one twisted and stands on
// its pedestal.
void lower_column(Primitive& out, float height, float detail);
void upper_column(Primitive& out, float height, float detail);
void pedestal(Primitive& out, float height, float detail);

// Rails and balusters between two pedestals, along x, centred; standing on y = 0.
void balustrade(Primitive& out, float clear_width, float detail);

// The wall over one bay with archivolts and keystones on both sides; springing line at y = 0.
void arcade_bay(Primitive& wall, Primitive& trim, float radius, float height, float detail);

// A round relief in the plane z = 0, facing +z: frame and boss.
void medallion(Primitive& frame, Primitive& boss, float detail);

// A door and a shuttered window on the wall z = 0, facing +z, standing on y = 0.
void door(Primitive& frame, Primitive& wood, float detail);
void window(Primitive& frame, Primitive& wood, float detail);

void fountain(Primitive& stone, Primitive& water, float detail);
void pot(Primitive& clay, Primitive& earth, float detail);
void shrub(Primitive& leaves, kit::Random& random, float detail);

// A runner laid over the balustrade rail and the cornice below it, falling into the court at +z; centred in x.
void runner(Primitive& cloth, float width, float fall, kit::Random& random, float detail);

// A curtain rod with knobs, along x, centred.
void rod(Primitive& iron, float width, float detail);

// Tiles of slightly different tints with joints, `tiles` each way over one texture; linear colours in, sRGB out.
Texture paving(const char* name, int tiles, bool checker, glm::vec3 light, glm::vec3 dark, kit::Random& random);

}  // namespace myriad::scenes::atrium
