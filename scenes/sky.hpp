// Light for scenes that bring none, as most files do that were made to be looked at in a viewer.
#pragma once

#include "scenes/scene.hpp"

namespace myriad::scenes {

// The default sky: an overcast one without colour, of this radiance in W/(m^2 sr) all over the upper hemisphere. White
// ground under it is as bright as the sky itself. Below the horizon there is no light, though what looks past the scene
// there sees the same background.
inline constexpr float default_sky_radiance = 1;

// How many directions stand for it: few enough to shoot a shadow ray for each, many enough that their shadows run together.
inline constexpr uint32_t default_sky_lights = 48;

enum class SkyChoice {
    automatic,  // where nothing else shines
    on,
    off,
};

// `count` directional lights that stand for the upper hemisphere at this radiance: each is the light of an equal solid angle
// from one direction in it. Directions are those of a Fibonacci spiral, evenly spread at every scale. On level ground the sum
// of their irradiances is pi * radiance, the sky's, but for rounding; on planes at other angles within a few hundredths.
std::vector<Light> sky_lights(float radiance, uint32_t count);

// Whether the default sky is wanted: there are lit surfaces, no light, and no emission. A texture of emission at no more than
// its plain strength does not count: exporters give it to displays and eyes, not to lamps.
bool needs_sky(const Scene& scene);

// Adds the default sky to the scene's lights, sets its background, and says so in a warning where nobody asked for it.
void apply_sky(Scene& scene, SkyChoice choice);

}  // namespace myriad::scenes
