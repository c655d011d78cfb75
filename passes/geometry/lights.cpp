#include "passes/geometry/lights.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {
namespace {

using glm::dvec3;

double mean(const dvec3& rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

// In W. Double: a hundred thousand small shares are summed.
double power_of(const Light& light) {
    const dvec3 intensity(light.intensity);
    switch (light.type) {
        case light_spot: return mean(intensity) * double(spot_solid_angle(light));
        case light_directional: {
            const vec3 areas = directional_areas(light);
            return mean(intensity) * (double(areas.x) + areas.y + areas.z);
        }
        default: return mean(intensity) * 4 * std::numbers::pi;
    }
}

// `lo`, `size`: the scene's bounds.
Light punctual_light(const scenes::Light& from, const vec3& lo, const vec3& size) {
    Light light{.position = from.position, .type = uint(from.type), .direction = from.direction, .cdf = 0,
                .intensity = from.intensity, .triangle = scenes::none, .extent = vec3(0), .cos_outer = 0};
    if (light.type == light_spot) {
        light.cos_outer = float(std::cos(double(from.outer_cone)));
        light.extent.x = float(std::max(0.001, std::cos(double(from.inner_cone)) - std::cos(double(from.outer_cone))));
    } else if (light.type == light_directional) {
        light.position = lo;
        light.extent = size;
    } else {
        light.extent.x = from.radius;
    }
    return light;
}

// What emissive triangles shine with in the mean.
class Radiometer {
public:
    Radiometer(const scenes::Triangles& triangles, const GeometryData& data) : triangles_(triangles), data_(data) {
        for (const Material& material : data.materials) whole_.push_back(whole(material));
        uint64_t looked_at = 0;
        for (const uvec4& t : triangles.triangles) looked_at += shines(t.w) && varies(t.w);
        while (side_ > 2 && uint64_t(side_) * side_ * looked_at > most_points) side_ /= 2;
    }

    bool shines(uint material) const { return whole_[material] != dvec3(0); }
    bool any_shines() const { return std::any_of(whole_.begin(), whole_.end(), [](const dvec3& r) { return r != dvec3(0); }); }

    // The mean over a grid of points of the triangle, and a little of the mean of the whole texture: a triangle all of whose points
    // are dark may shine between them, and what has no power is never chosen.
    dvec3 mean(uint id) const {
        const compute::OpacityPlace at = data_.world.place(id);
        uvec4 corners = triangles_.triangles[at.triangle];
        if (at.mirrored) std::swap(corners.y, corners.z);
        if (!varies(corners.w)) return whole_[corners.w];
        if (data_.world.opacity.kind(at.triangle) == compute::Opacity::Kind::nowhere) return dvec3(0);
        dvec3 sum(0);
        for (int i = 0; i < side_; ++i)
            for (int j = 0; j < side_; ++j) {
                float u = (float(i) + 0.5f) / float(side_), v = (float(j) + 0.5f) / float(side_);
                if (u + v > 1) u = 1 - u, v = 1 - v;
                sum += double(data_.world.mean_opacity(id, u, v)) * at_point(corners, u, v);
            }
        return 0.9 * sum / double(side_ * side_) + 0.1 * whole_[corners.w];
    }

private:
    static constexpr uint64_t most_points = 1 << 22;

    bool varies(uint material) const { return data_.materials[material].emission_texture != no_texture || data_.alphas[material].cutoff != 0; }

    dvec3 texel(uint word) const {
        const auto linear = [&](uint code) { return double(uintBitsToFloat(data_.texels[code & 255u])); };
        return {linear(word), linear(word >> 8), linear(word >> 16)};
    }
    dvec3 whole(const Material& material) const {
        const dvec3 radiance(material.emission);
        if (material.emission_texture == no_texture) return radiance;
        const TextureRef& t = data_.textures[material.emission_texture];
        dvec3 sum(0);
        const uint64_t count = uint64_t(t.width) * t.height;
        for (uint64_t i = 0; i < count; ++i) sum += texel(data_.texels[t.first + i]);
        return radiance * sum / double(count);
    }
    dvec3 at_point(const uvec4& corners, float u, float v) const {
        const Material& material = data_.materials[corners.w];
        if (material.emission_texture == no_texture) return dvec3(material.emission);
        const TextureRef& t = data_.textures[material.emission_texture];
        const auto& of = texture_set(t) == 0 ? triangles_.texcoords : triangles_.texcoords1;
        const TexelQuad q = texel_quad(t, texture_place(t, (1 - u - v) * of[corners.x] + u * of[corners.y] + v * of[corners.z]));
        const auto row = [&](uint left, uint right) { return glm::mix(texel(data_.texels[left]), texel(data_.texels[right]), double(q.weight.x)); };
        return dvec3(material.emission) * glm::mix(row(q.word.x, q.word.y), row(q.word.z, q.word.w), double(q.weight.y));
    }

    const scenes::Triangles& triangles_;
    const GeometryData& data_;
    std::vector<dvec3> whole_;  // of materials, with the mean of all texels standing for the texture
    int side_ = 8;              // of the grid
};

double area_of(const Corners& c) {
    const dvec3 p(c.p0);
    return 0.5 * glm::length(glm::cross(dvec3(c.p1) - p, dvec3(c.p2) - p));
}

}  // namespace

LightData light_data(const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry, bool points_apart) {
    LightData data;
    if (points_apart) {
        const auto is_other = [&](uint32_t i) { return scene.lights[i].type != scenes::Light::Type::point; };
        data.order.resize(scene.lights.size());
        std::iota(data.order.begin(), data.order.end(), 0u);
        data.apart = uint32_t(data.order.end() - std::stable_partition(data.order.begin(), data.order.end(), is_other));
    }
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        data.lights.push_back(punctual_light(scene.lights[points_apart ? data.order[i] : i], triangles.lo, triangles.hi - triangles.lo));
        data.powers.push_back(power_of(data.lights.back()));
    }
    data.punctual = uint32_t(data.lights.size());
    if (scene.environment) data.environment = uint32_t(scene.environment->solid_angles.size());

    const Radiometer radiometer(triangles, geometry);
    if (radiometer.any_shines()) geometry.world.for_each([&](uint32_t i, uint32_t stored, const Corners& corners) {
        const uint32_t material = triangles.triangles[stored].w;
        if (!radiometer.shines(material)) return;
        const dvec3 radiance = radiometer.mean(i);
        const int sides = scene.materials[material].double_sided ? 2 : 1;
        const double area = sides * area_of(corners);
        const double power = mean(radiance) * std::numbers::pi * area;
        const bool moves = geometry.world.moves(stored) && mean(radiance) > 0;
        if (!(power > 0) && !moves) return;
        if (moves) data.moving.push_back({uint(data.lights.size()), stored, float(sides)});
        data.lights.push_back({.position = vec3(0), .type = light_triangle, .direction = vec3(0), .cdf = 0, .intensity = vec3(radiance),
                               .triangle = uint(i), .extent = vec3(float(area), 0, 0), .cos_outer = 0});
        data.powers.push_back(power);
    });
    for (double power : data.powers) data.power += power;
    // What moves has a share even where it has no area yet: a hundredth of the mean.
    const double least = 0.01 * data.power / double(std::max<size_t>(data.lights.size(), 1));
    for (const Emitter& e : data.moving) data.powers[e.light] = std::max(data.powers[e.light], least);
    share_out(data.lights, data.powers);
    return data;
}

void share_out(std::vector<Light>& lights, const std::vector<double>& weights) {
    double total = 0, sum = 0;
    for (double weight : weights) total += weight;
    for (size_t i = 0; i < lights.size(); ++i) {
        sum += weights[i];
        lights[i].cdf = total > 0 ? float(sum / total) : 0;
    }
    // Rounding must not leave a gap at the end, nor give it to lights of no weight.
    for (size_t i = lights.size(); total > 0 && i-- > 0;) {
        lights[i].cdf = 1;
        if (weights[i] > 0) break;
    }
}

void move_lights(std::vector<Light>& copy, std::span<const Light> punctual_now, const std::vector<double>& weights) {
    bool left_out = false;
    for (size_t i = 0; i < punctual_now.size(); ++i) {
        const float share = copy[i].cdf - (i > 0 ? copy[i - 1].cdf : 0), cdf = copy[i].cdf;
        left_out = left_out || (weights[i] > 0 && !(share > 0));
        copy[i] = punctual_now[i];
        copy[i].cdf = cdf;
    }
    if (left_out) share_out(copy, weights);
}

LightTable::LightTable(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& geometry, bool points_apart)
    : LightTable(device, light_data(scene, triangles, geometry, points_apart)) {}

LightTable::LightTable(engine::Device& device, LightData data)
    : device_(device), data_(std::move(data)), lights_(engine::upload(device, "scene", "lights", data_.lights)),
      moving_(engine::upload(device, "scene", "lights that move", data_.moving)) {
    if (!data_.moving.empty()) emitters_.emplace(device, engine::passes_kernels, "geometry/emitters");
}

void LightTable::move(std::span<const scenes::Light> lights) {
    assert(lights.size() == punctual());
    std::vector<Light> now;
    for (size_t i = 0; i < lights.size(); ++i) {
        const Light& before = data_.lights[i];
        const scenes::Light& light = lights[data_.order.empty() ? i : data_.order[i]];
        assert(uint(light.type) == before.type);
        now.push_back(punctual_light(light, before.position, before.extent));
        now.back().cdf = before.cdf;
    }
    if (now.empty() || std::memcmp(now.data(), data_.lights.data(), now.size() * sizeof(Light)) == 0) return;
    for (size_t i = 0; i < now.size(); ++i) data_.powers[i] = power_of(now[i]);
    data_.power = std::accumulate(data_.powers.begin(), data_.powers.end(), 0.0);
    move_lights(data_.lights, now, data_.powers);
    engine::upload_bytes(device_, data_.lights.data(), lights_, lights_.bytes());
    ++moves_;
}

void LightTable::follow(engine::Recorder& recorder, const Geometry& geometry) {
    if (!emitters_) return;
    recorder.dispatch(*emitters_,
                      EmittersPush{.emitters = recorder.read(moving_), .triangles = recorder.read(geometry.triangles()),
                                   .positions = recorder.read(geometry.positions()), .lights = recorder.write(lights_),
                                   .count = uint(moving_.count())},
                      moving_.count());
}

}  // namespace myriad::passes
