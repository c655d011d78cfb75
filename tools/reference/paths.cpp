#include "tools/reference/paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace myriad::reference {
namespace {

// Veach's power heuristic: the weight of what was taken with density a and could have been with b.
float weight(float a, float b) { return a * a / (a * a + b * b); }

// What is left of a geometry term under a bound.
float within(float bound, float geometry) { return geometry > bound ? bound / geometry : 1; }

float largest(const vec3& v) { return std::max({v.x, v.y, v.z}); }

// A lamp that touches a surface is not hidden by it: shadow rays to punctual lights end early by this part, as the device's do.
constexpr float to_lamp = 0.9999f;
// From the fourth reflection on paths end by chance, in proportion to what they have lost.
constexpr uint32_t sure_bounces = 3;
constexpr float unbound = std::numeric_limits<float>::infinity();

}  // namespace

Paths::Paths(const scenes::Scene& scene, std::span<const scenes::Light> lights, const scenes::Triangles& triangles, uint32_t bounces, Model model, float bound)
    : bounces_(bounces), model_(model), bound_(bound), background_(scene.background), surfaces_(scene, triangles), tracer_(triangles, surfaces_), punctual_(scene, lights),
      emitters_(surfaces_), surroundings_(scene.environment ? std::optional<Surroundings>(*scene.environment) : std::nullopt) {}

vec3 Paths::punctual(const Surface& s, const Brdf& brdf, Sampler& sampler) const {
    if (punctual_.empty()) return vec3(0);
    const vec2 x = sampler.pair();
    const uint32_t dice = sampler.dice();
    const auto chosen = punctual_.choose(s.position, x, [&](const Incident& i) { return largest(i.irradiance * brdf.times_cosine(i.direction)); });
    if (!chosen) return vec3(0);
    const Incident& i = chosen->incident;
    const vec3 way = i.far ? i.way : i.way - (s.origin - s.position);
    if (tracer_.occluded(s.origin, way, i.far ? unbound : to_lamp, dice)) return vec3(0);
    return brdf.times_cosine(i.direction) * i.irradiance * chosen->weight;
}

vec3 Paths::emitters(const Surface& s, const Brdf& brdf, float bound, Sampler& sampler) const {
    if (emitters_.empty()) return vec3(0);
    const float choice = sampler.one();
    const vec2 x = sampler.pair();
    const uint32_t dice = sampler.dice();
    const auto e = emitters_.sample(s.position, choice, x);
    if (!e) return vec3(0);
    const vec3 reflected = brdf.times_cosine(e->direction) * e->radiance;
    if (reflected == vec3(0)) return vec3(0);
    if (tracer_.occluded(s.origin, e->way - (s.origin - s.position), 1, dice)) return vec3(0);
    return reflected * (weight(e->density, brdf.density(e->direction)) / e->density * within(bound, glm::dot(s.shading, e->direction) * e->facing));
}

vec3 Paths::surroundings(const Surface& s, const Brdf& brdf, Sampler& sampler) const {
    if (!surroundings_) return vec3(0);
    const vec2 x = sampler.pair();
    const uint32_t dice = sampler.dice();
    const auto e = surroundings_->sample(x);
    if (!e) return vec3(0);
    const vec3 reflected = brdf.times_cosine(e->direction) * e->radiance;
    if (reflected == vec3(0) || tracer_.occluded(s.origin, e->direction, unbound, dice)) return vec3(0);
    return reflected * (weight(e->density, brdf.density(e->direction)) / e->density);
}

Radiance Paths::along(const vec3& origin, const vec3& direction, Sampler& sampler) const {
    Radiance sum;
    const auto first = tracer_.closest(origin, direction, sampler.dice());
    Surface s;
    if (first) s = surfaces_.at(first->triangle, first->u, first->v, direction);
    sum.emission = first ? s.emission : surroundings_ ? surroundings_->seen(direction) : background_;
    sum.emission += punctual_.glow(origin, direction, first ? glm::length(s.position - origin) : unbound);
    if (!first || s.unlit) return sum;

    vec3 view = -direction, through(1);
    for (uint32_t bounce = 0;; ++bounce) {
        const Brdf brdf(s, view, model_);
        if (brdf.black()) break;
        (bounce == 0 ? sum.direct : sum.indirect) += through * punctual(s, brdf, sampler);
        sum.indirect += through * emitters(s, brdf, bounce == 0 ? bound_ : unbound, sampler);
        sum.indirect += through * surroundings(s, brdf, sampler);
        const bool last = bounce == bounces_;
        if (last && emitters_.empty() && !surroundings_) break;

        const float choice = sampler.one();
        const Brdf::Sample next = brdf.sample(choice, sampler.pair());
        const uint32_t dice = sampler.dice();
        if (!(next.density > 0)) break;
        through *= next.weight;
        const auto hit = tracer_.closest(s.origin, next.direction, dice);
        if (!hit) {
            if (surroundings_) sum.indirect += through * surroundings_->radiance(next.direction) * weight(next.density, surroundings_->density(next.direction));
            break;
        }
        const Surface met = surfaces_.at(hit->triangle, hit->u, hit->v, next.direction);
        if (met.unlit) break;
        if (bounce == 0) {
            const vec3 way = met.position - s.position;
            through *= within(bound_, glm::dot(s.shading, next.direction) * std::abs(glm::dot(met.geometric, next.direction)) / glm::dot(way, way));
        }
        if (met.emission != vec3(0)) sum.indirect += through * met.emission * weight(next.density, emitters_.density(s.position, met));
        if (last) break;
        if (bounce >= sure_bounces) {
            const float stays = std::min(largest(through), 1.0f);
            if (!(sampler.one() < stays)) break;
            through /= stays;
        }
        s = met;
        view = -next.direction;
    }
    return sum;
}

}  // namespace myriad::reference
