// Where light comes from: punctual lights, emissive triangles, and the picture that surrounds the scene. Each kind is sampled by itself.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "tools/reference/surface.hpp"

namespace myriad::reference {

// What one light sends to a point.
struct Incident {
    vec3 way;             // from the point to the light, metres; a unit vector towards what is infinitely far
    bool far = false;     // infinitely
    vec3 direction;       // unit, the same way
    vec3 irradiance{0};   // on a plane perpendicular to it, W/m^2
};

// Point lights, spots and suns, those of the default sky among them; not those that stand for an environment.
class Punctual {
public:
    Punctual(const scenes::Scene& scene, std::span<const scenes::Light> lights);

    bool empty() const { return lights_.empty(); }
    // One light, chosen in proportion to `worth` of what it sends (all lights are asked where they are few, else candidates by power: resampled
    // importance sampling, Talbot 2005); its irradiance is divided by the probability. `x` in [0, 1).
    struct Chosen {
        Incident incident;
        float weight;
    };
    std::optional<Chosen> choose(const vec3& position, const vec2& x, const std::function<float(const Incident&)>& worth) const;
    // The ball that is seen of the lights with a radius, along a ray that ends at `distance`: the sum of their radiance.
    vec3 glow(const vec3& origin, const vec3& direction, float distance) const;

    static Incident incident(const scenes::Light& light, const vec3& position);

private:
    std::vector<scenes::Light> lights_;
    std::vector<uint32_t> balls_;  // of lights_: those with a radius
    std::vector<double> sums_;     // of power, up to and with each
};

// A point on an emissive triangle as another point sees it.
struct Emitted {
    vec3 way;             // to just before it, metres
    vec3 direction;       // unit
    vec3 radiance;
    float density;        // 1/sr, as seen from the point
    float facing;         // its cosine over the squared distance, 1/m^2
};

// Triangles that emit, chosen by area times mean radiance.
class Emitters {
public:
    explicit Emitters(const Surfaces& surfaces);

    bool empty() const { return triangles_.empty(); }
    std::optional<Emitted> sample(const vec3& position, float choice, const vec2& x) const;
    // Density with which sample() takes the point of a triangle that a ray from `position` has met: 1/sr.
    float density(const vec3& position, const Surface& met) const;

private:
    const Surfaces& surfaces_;
    std::vector<uint32_t> triangles_;  // in ascending order
    std::vector<double> sums_;         // of power, up to and with each
    std::vector<float> per_area_;      // one a triangle here: probability over area, 1/m^2
};

// The picture around the scene. Its texels are even for what it lights, and blended where it is seen.
class Surroundings {
public:
    explicit Surroundings(const scenes::Environment& picture);

    struct Sample {
        vec3 direction;
        vec3 radiance;
        float density;    // 1/sr
    };
    std::optional<Sample> sample(const vec2& x) const;
    vec3 radiance(const vec3& direction) const;
    float density(const vec3& direction) const;
    vec3 seen(const vec3& direction) const;

private:
    struct Place {
        double column, row;
    };
    Place place(const vec3& direction) const;
    size_t texel(const vec3& direction) const;
    float probability(size_t texel) const;

    const scenes::Environment& picture_;
    std::vector<double> solid_angles_;  // of a texel, by row
    std::vector<double> rows_;          // probability of all rows up to and with each
    std::vector<float> columns_;        // within its row, of all texels up to and with each
};

}  // namespace myriad::reference
