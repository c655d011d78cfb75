// Path-traced references for experiments: made once, kept in a folder.
#pragma once

#include "passes/frame.hpp"
#include "tools/bench/bench.hpp"
#include "tools/image.hpp"
#include "tools/reference/reference.hpp"

namespace myriad::tools {

struct PathReference {
    Image image;
    uint32_t samples = 0;  // a pixel
    double noise = 0;      // relMSE that it is expected to have, by its own variance: an upper bound in the mean
};

// How many pixels, bounces and which reflection the frame's settings have; of no end of samples.
reference::Settings path_settings(const passes::FrameSettings& frame, uint32_t seed);

// Of the options' --reference-seconds, or what --references has of the same scene and settings, however long that took. `flat` is the scene with all
// instances written out. Paths are others than those of the options' seed.
PathReference path_reference(const BenchOptions& options, const std::string& name, const scenes::Scene& scene, const scenes::Triangles& flat, const scenes::Camera& camera,
                             const passes::FrameSettings& frame);

}  // namespace myriad::tools
