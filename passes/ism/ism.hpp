// Imperfect shadow maps: few points a view, and holes filled; see README.md.
#pragma once

#include "compute/raytrace/bvh.hpp"
#include "compute/surface_sampling/surface_sampling.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/ism/ism_io.h"

namespace myriad::passes {

// The defaults are those of least error on two scenes (README.md).
struct IsmSettings {
    uint32_t points = 8192;     // a view
    float cover = 1.1f;        // a point's radius, in that of a disc of its share of the surface
    uint32_t levels = 1;        // of pull and push; 0: holes stay
    float threshold = 1;        // in the scene's extent at level 0, doubled at each: how far apart depths of one surface may be
};

// What ISM draws, on the host; need not outlive the pass.
struct IsmScene {
    const compute::WorldTriangles& world;
    const compute::SurfaceSampling& sampling;
    float extent = 0;  // of the scene: the longest side of its box
};

class IsmPass {
public:
    IsmPass(engine::Device& device, const IsmScene& scene, const IsmSettings& settings, uint32_t seed);

    // Finds where the samples stand: once, and when the scene has moved.
    void place(engine::Recorder& recorder, const Geometry& geometry);

    // Clears `atlas` (map_texels(map_size) words a view, view `first` first) and draws those of the views [first, first + limit) that
    // exist into it.
    void record(engine::Recorder& recorder, const engine::Array<View>& views, const engine::Array<uint>& count, uint32_t first, uint32_t limit,
                uint32_t map_size, const engine::Array<uint>& atlas);

    const engine::Array<IsmPoint>& points() const { return points_; }
    float radius() const { return radius_; }

private:
    engine::Device& device_;
    IsmSettings settings_;
    uint32_t seed_;
    bool blends_;
    float radius_, threshold_;
    engine::Program place_, splat_, pull_, push_;
    engine::Array<SurfaceSample> samples_;
    engine::Array<IsmPoint> points_;
    std::vector<engine::Array<uint>> levels_;  // from level 1 on
};

}  // namespace myriad::passes
