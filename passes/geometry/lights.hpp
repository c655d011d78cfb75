// The light table: punctual lights, then emissive triangles, with shares of power for sampling; see README.md.
#pragma once

#include <optional>
#include <span>

#include "engine/recorder.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/light_io.h"
#include "scenes/scene.hpp"

namespace myriad::passes {

struct LightData {
    std::vector<Light> lights;
    std::vector<double> powers;  // W, mean of R, G, B, a light: what `cdf` shares out
    uint32_t punctual = 0;       // the first so many; the rest are emissive triangles
    uint32_t environment = 0;    // the last so many of the punctual ones stand for the environment
    double power = 0;            // of all
    std::vector<Emitter> moving; // the emissive triangles that do; all of them, for one without area may get some
};
// `geometry`: what geometry_data makes of the same.
LightData light_data(const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry);

// Sets each light's cdf, so that lights are chosen in proportion to these weights, a light's share of the whole each.
void share_out(std::vector<Light>& lights, const std::vector<double>& weights);

// Puts punctual lights where they are now, in a copy of the table of old whose shares may differ from it. Shares stay, for paths stay
// with their lights; but where a light shines that has none, all are dealt out anew by these weights.
void move_lights(std::vector<Light>& copy, std::span<const Light> punctual_now, const std::vector<double>& weights);

class LightTable {
public:
    LightTable(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry);

    // The scene's punctual lights have moved: they are as many, of the same kinds, in the same order. Between submissions. Does
    // nothing where they stand as they stood.
    void move(std::span<const scenes::Light> lights);
    uint32_t moves() const { return moves_; }  // how often that was, for who holds a copy

    // Emissive triangles have moved, after what else has: they shine by the area that they have now, with the share of paths that
    // they had. Records nothing where none moves.
    void follow(engine::Recorder& recorder, const Geometry& geometry);

    Ref<Light> read(engine::Recorder& recorder) const { return recorder.read(lights_); }

    const engine::Array<Light>& array() const { return lights_; }
    uint32_t count() const { return uint32_t(lights_.count()); }
    uint32_t punctual() const { return data_.punctual; }
    uint32_t lamps() const { return data_.punctual - data_.environment; }  // the punctual ones that stand for nothing else, which are first
    bool has_emissive() const { return count() > punctual(); }
    double power() const { return data_.power; }   // 0: nothing shines
    const LightData& data() const { return data_; }  // for who weighs the lights anew

private:
    LightTable(engine::Device& device, LightData data);

    engine::Device& device_;
    LightData data_;
    engine::Array<Light> lights_;
    engine::Array<Emitter> moving_;
    std::optional<engine::Program> emitters_;  // where some move
    uint32_t moves_ = 0;
};

}  // namespace myriad::passes
