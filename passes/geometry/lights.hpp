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
    uint32_t environment = 0;    // of the punctual ones, those that stand for the environment: the last but for points that are apart
    uint32_t apart = 0;          // the last so many of the punctual ones are the point lights, where they are asked for apart; else 0
    std::vector<uint32_t> order; // of the punctual ones, by place here: which of the scene's; empty: the same
    double power = 0;            // of all
    uint32_t guided() const { return punctual - apart; }  // that paths are guided from (passes/vpl): the first
    std::vector<Emitter> moving; // the emissive triangles that do; all of them, for one without area may get some
};
// `geometry`: what geometry_data makes of the same.
LightData light_data(const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry, bool points_apart = false);

// Sets each light's cdf, so that lights are chosen in proportion to these weights, a light's share of the whole each.
void share_out(std::vector<Light>& lights, const std::vector<double>& weights);

// Puts punctual lights where they are now, in a copy of the table of old whose shares may differ from it. Shares stay, for paths stay
// with their lights; but where a light shines that has none, all are dealt out anew by these weights.
void move_lights(std::vector<Light>& copy, std::span<const Light> punctual_now, const std::vector<double>& weights);

class LightTable {
public:
    // `points_apart`: point lights come after all other punctual ones, for who takes care of them.
    LightTable(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry, bool points_apart = false);

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
    uint32_t lamps() const { return data_.punctual - data_.environment - data_.apart; }  // the punctual ones that are nobody else's, which are first
    std::span<const Light> points_apart() const { return std::span(data_.lights).subspan(data_.punctual - data_.apart, data_.apart); }
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
