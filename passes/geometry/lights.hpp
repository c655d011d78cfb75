// The light table: punctual lights, then emissive triangles, with shares of power for sampling; see README.md.
#pragma once

#include "engine/recorder.hpp"
#include "passes/geometry/light_io.h"
#include "scenes/scene.hpp"

namespace myriad::passes {

struct LightData {
    std::vector<Light> lights;
    uint32_t punctual = 0;  // the first so many; the rest are emissive triangles
    double power = 0;       // W, mean of R, G, B: what `cdf` is a share of
};
LightData light_data(const scenes::Scene& scene, const scenes::Triangles& triangles);

class LightTable {
public:
    LightTable(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles);

    Ref<Light> read(engine::Recorder& recorder) const { return recorder.read(lights_); }

    uint32_t count() const { return uint32_t(lights_.count()); }
    uint32_t punctual() const { return punctual_; }
    bool has_punctual() const { return punctual_ > 0; }
    bool has_emissive() const { return count() > punctual_; }
    double power() const { return power_; }  // 0: nothing shines

private:
    LightTable(engine::Device& device, const LightData& data);

    engine::Array<Light> lights_;
    uint32_t punctual_;
    double power_;
};

}  // namespace myriad::passes
