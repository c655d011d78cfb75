// The light table: punctual lights, then emissive triangles, with shares of power for sampling; see README.md.
#pragma once

#include "engine/recorder.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/light_io.h"
#include "scenes/scene.hpp"

namespace myriad::passes {

struct LightData {
    std::vector<Light> lights;
    std::vector<double> powers;  // W, mean of R, G, B, a light: what `cdf` shares out
    uint32_t punctual = 0;       // the first so many; the rest are emissive triangles
    double power = 0;            // of all
};
// `geometry`: what geometry_data makes of the same.
LightData light_data(const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry);

// Sets each light's cdf, so that lights are chosen in proportion to these weights, a light's share of the whole each.
void share_out(std::vector<Light>& lights, const std::vector<double>& weights);

class LightTable {
public:
    LightTable(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry);

    Ref<Light> read(engine::Recorder& recorder) const { return recorder.read(lights_); }

    uint32_t count() const { return uint32_t(lights_.count()); }
    uint32_t punctual() const { return data_.punctual; }
    bool has_punctual() const { return punctual() > 0; }
    bool has_emissive() const { return count() > punctual(); }
    double power() const { return data_.power; }   // 0: nothing shines
    const LightData& data() const { return data_; }  // for who weighs the lights anew

private:
    LightTable(engine::Device& device, LightData data);

    LightData data_;
    engine::Array<Light> lights_;
};

}  // namespace myriad::passes
