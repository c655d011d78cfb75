// How flatten() takes each instance.
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace myriad::scenes {

enum class Stance : uint8_t {
    still,   // its transform places it, for good
    posed,   // skinned or morphed, but nothing that plays changes that: applied once
    moving,  // a clip that plays moves its node, one of its joints, or its morph weights
};
// One an instance.
std::vector<Stance> stances(const Scene& scene, const Playback& playback);

}  // namespace myriad::scenes
