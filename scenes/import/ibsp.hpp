// Maps of Quake III Arena and the games made with its engine (OpenArena), format IBSP 46: what its tools left of a level.
//
// Read: polygons, triangle meshes, and patches, which are tessellated; doors and the like in their places; `light` entities;
// spawn points as cameras, the intermission view first. Left out: sky, clip, hint and trigger surfaces, fog and flares, and
// everything that serves visibility and collisions. Light maps are not used: the renderer makes the light.
//
// A map names its textures and holds none. A surface's look is made up from its shader's name (ibsp_look.hpp), and so is the
// light of surfaces that shine.
#pragma once

#include "scenes/import/bytes.hpp"
#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

inline constexpr double ibsp_unit = 1.0 / 32;  // metres: makes a player, 56 units, 1.75 m

struct IbspOptions {
    float unit = float(ibsp_unit);  // what light intensities are for
    // From a patch's curves to the chords that replace them, in the map's units: 1 cm. Neighbouring patches may be cut
    // differently: the gap between them is at most twice this.
    float tolerance = 0.32f;
};

// In the map's units, z up.
Scene read_ibsp(const View& file, const IbspOptions& options = {});

// A Reader.
Imported import_ibsp(const std::string& path, const ImportOptions& options);

}  // namespace myriad::scenes::importing
