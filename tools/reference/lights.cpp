#include "tools/reference/lights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace myriad::reference {
namespace {

using scenes::Light;
constexpr double pi = std::numbers::pi;
constexpr size_t most_asked = 64;  // lights; of more, as many candidates

double luminance(const glm::dvec3& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

// Index of the first sum beyond a share of the whole.
size_t pick(std::span<const double> sums, double share) {
    const auto at = std::ranges::upper_bound(sums, share * sums.back());
    return std::min(size_t(at - sums.begin()), sums.size() - 1);
}

double power(const Light& l) {
    const double i = luminance(l.intensity);
    if (l.type == Light::Type::directional) return i;
    return i * 4 * pi;  // a spot's within its cone; this only steers candidates
}

}  // namespace

Punctual::Punctual(const scenes::Scene& scene, std::span<const Light> lights) {
    const size_t stand_ins = scene.environment ? scene.environment->solid_angles.size() : 0;  // the last ones: the picture itself is sampled
    double sum = 0;
    for (const Light& l : lights.first(lights.size() - stand_ins)) {
        if (l.intensity == vec3(0)) continue;
        if (l.type == Light::Type::point && l.radius > 0) balls_.push_back(uint32_t(lights_.size()));
        lights_.push_back(l);
        sums_.push_back(sum += power(l));
    }
}

// KHR_lights_punctual, units 1:1 (spec, section 5). Within its radius, a light grows no more.
Incident Punctual::incident(const Light& l, const vec3& position) {
    if (l.type == Light::Type::directional) return {.way = -l.direction, .far = true, .direction = -l.direction, .irradiance = l.intensity};
    Incident in{.way = l.position - position, .direction = vec3(0)};
    const float squared = glm::dot(in.way, in.way);
    if (!(squared > 0)) return in;  // in the light itself there is no direction
    in.direction = in.way / std::sqrt(squared);
    in.irradiance = l.intensity / std::max(squared, l.radius * l.radius);
    if (l.type == Light::Type::spot) {
        const double inner = std::cos(double(l.inner_cone)), outer = std::cos(double(l.outer_cone));
        const double part = std::clamp((-double(glm::dot(in.direction, l.direction)) - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
        in.irradiance *= float(part * part);
    }
    return in;
}

std::optional<Punctual::Chosen> Punctual::choose(const vec3& position, const vec2& x, const std::function<float(const Incident&)>& worth) const {
    const bool all = lights_.size() <= most_asked;
    std::array<Incident, most_asked> incidents;
    std::array<float, most_asked> worths, shares;  // shares: one over how many candidates there are of each light in the mean
    const size_t count = all ? lights_.size() : most_asked;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        size_t light = i;
        shares[i] = 1;
        if (!all) {
            light = pick(sums_, (double(i) + double(x.y)) / double(most_asked));
            shares[i] = float(sums_.back() / (double(most_asked) * (sums_[light] - (light ? sums_[light - 1] : 0))));
        }
        incidents[i] = incident(lights_[light], position);
        worths[i] = worth(incidents[i]);
        sum += double(worths[i]) * double(shares[i]);
    }
    if (!(sum > 0)) return {};
    double left = double(x.x) * sum;
    for (size_t i = 0; i < count; ++i) {
        const double here = double(worths[i]) * double(shares[i]);
        if (here > 0 && left < here) return Chosen{incidents[i], float(sum / double(worths[i]))};
        left -= here;
    }
    return {};  // by rounding, once in 2^24
}

vec3 Punctual::glow(const vec3& origin, const vec3& direction, float distance) const {
    vec3 sum(0);
    for (const uint32_t i : balls_) {
        const Light& l = lights_[i];
        const vec3 to = l.position - origin;
        const float along = glm::dot(to, direction), radius2 = l.radius * l.radius;
        const vec3 off = to - along * direction;
        if (along <= 0 || along >= distance || glm::dot(off, off) >= radius2 || glm::dot(to, to) <= radius2) continue;
        sum += l.intensity / (float(pi) * radius2);
    }
    return sum;
}

Emitters::Emitters(const Surfaces& surfaces) : surfaces_(surfaces) {
    std::vector<double> areas;
    double sum = 0;
    for (uint32_t t = 0; t < surfaces.count(); ++t) {
        if (!surfaces.emits(t)) continue;
        const auto p = surfaces.corners(t);
        const double area = 0.5 * glm::length(glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0])));
        if (!(area > 0)) continue;
        // A few points of it, and a tenth of the whole texture's mean: what is dark at those may shine elsewhere.
        double radiance = 0;
        constexpr int side = 4;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                float u = (float(i) + 0.5f) / side, v = (float(j) + 0.5f) / side;
                if (u + v > 1) u = 1 - u, v = 1 - v;
                radiance += 0.9 / (side * side) * luminance(surfaces.emission(t, u, v)) * double(surfaces.opacity(t, u, v));
            }
        radiance += 0.1 * luminance(surfaces.mean_emission(t));
        triangles_.push_back(t);
        areas.push_back(area);
        sums_.push_back(sum += area * radiance * (surfaces.double_sided(t) ? 2 : 1));
    }
    for (size_t i = 0; i < triangles_.size(); ++i) per_area_.push_back(float((sums_[i] - (i ? sums_[i - 1] : 0)) / sum / areas[i]));
}

std::optional<Emitted> Emitters::sample(const vec3& position, float choice, const vec2& x) const {
    const size_t i = pick(sums_, double(choice));
    const uint32_t t = triangles_[i];
    float u = 1 - std::sqrt(1 - x.x), v = x.y * (1 - u);
    const auto p = surfaces_.corners(t);
    const vec3 point = (1 - u - v) * p[0] + u * p[1] + v * p[2];
    vec3 normal = unit_or(glm::cross(p[1] - p[0], p[2] - p[0]), vec3(0));
    vec3 way = point - position;
    float cosine = -glm::dot(normal, way);
    if (cosine < 0 && surfaces_.double_sided(t)) cosine = -cosine, normal = -normal;
    const float squared = glm::dot(way, way);
    if (!(cosine > 0) || !(squared > 0)) return {};
    const float distance = std::sqrt(squared);
    Emitted e;
    e.direction = way / distance;
    e.radiance = surfaces_.emission(t, u, v) * surfaces_.opacity(t, u, v);
    e.density = per_area_[i] * squared * distance / cosine;
    e.facing = cosine / (squared * distance);
    e.way = way + Surfaces::error_of(p) * normal;
    return e;
}

float Emitters::density(const vec3& position, const Surface& met) const {
    const auto at = std::ranges::lower_bound(triangles_, met.triangle);
    if (at == triangles_.end() || *at != met.triangle) return 0;
    const vec3 way = met.position - position;
    const float squared = glm::dot(way, way), cosine = std::abs(glm::dot(met.geometric, way));
    return cosine > 0 ? per_area_[size_t(at - triangles_.begin())] * squared * std::sqrt(squared) / cosine : 0;
}

Surroundings::Surroundings(const scenes::Environment& picture) : picture_(picture) {
    std::vector<double> row_sums;
    double whole = 0;
    for (uint32_t y = 0; y < picture.height; ++y) {
        solid_angles_.push_back(picture.solid_angle(y));
        double sum = 0;
        std::vector<double> sums;
        for (uint32_t x = 0; x < picture.width; ++x) sums.push_back(sum += luminance(picture.texels[size_t(y) * picture.width + x]));
        for (const double s : sums) columns_.push_back(sum > 0 ? float(s / sum) : 0);
        if (sum > 0) columns_.back() = 1;
        rows_.push_back(whole += sum * solid_angles_[y]);
    }
    if (whole > 0)
        for (double& r : rows_) r /= whole;
}

float Surroundings::probability(size_t texel) const {
    const size_t y = texel / picture_.width, x = texel % picture_.width;
    const float column = columns_[texel] - (x ? columns_[texel - 1] : 0);
    return float((rows_[y] - (y ? rows_[y - 1] : 0)) * double(column));
}

std::optional<Surroundings::Sample> Surroundings::sample(const vec2& x) const {
    if (!(rows_.back() > 0)) return {};
    const size_t row = std::min(size_t(std::ranges::upper_bound(rows_, double(x.y)) - rows_.begin()), rows_.size() - 1);
    const double before = row ? rows_[row - 1] : 0, in_row = (double(x.y) - before) / (rows_[row] - before);
    const auto begin = columns_.begin() + std::ptrdiff_t(row * picture_.width), end = begin + picture_.width;
    const size_t column = std::min(size_t(std::upper_bound(begin, end, x.x) - begin), size_t(picture_.width) - 1);
    const float left = column ? begin[std::ptrdiff_t(column) - 1] : 0, width = begin[std::ptrdiff_t(column)] - left;
    const size_t texel = row * picture_.width + column;
    const float p = probability(texel);
    if (!(p > 0)) return {};
    const double across = std::clamp(double((x.x - left) / width), 0.0, 1.0);
    return Sample{vec3(picture_.direction(double(column) + across, std::min(double(row) + in_row, double(row) + 1 - 1e-9))), picture_.texels[texel], float(p / solid_angles_[row])};
}

Surroundings::Place Surroundings::place(const vec3& direction) const {
    const glm::dvec3 d(direction);
    const double around = (std::atan2(d.z, d.x) + picture_.rotation) / (2 * pi) + 0.5, down = std::atan2(std::hypot(d.x, d.z), d.y) / pi;
    return {(around - std::floor(around)) * picture_.width, down * picture_.height};
}

size_t Surroundings::texel(const vec3& direction) const {
    const Place at = place(direction);
    return size_t(std::min(at.row, picture_.height - 1.0)) * picture_.width + size_t(std::min(at.column, picture_.width - 1.0));
}

vec3 Surroundings::radiance(const vec3& direction) const { return picture_.texels[texel(direction)]; }

float Surroundings::density(const vec3& direction) const {
    const size_t t = texel(direction);
    return float(double(probability(t)) / solid_angles_[t / picture_.width]);
}

vec3 Surroundings::seen(const vec3& direction) const {
    const Place at = place(direction);
    const double x = at.column - 0.5, y = at.row - 0.5;
    const int64_t w = picture_.width, h = picture_.height, left = int64_t(std::floor(x)), upper = int64_t(std::floor(y));
    const auto read = [&](int64_t column, int64_t row) {
        return picture_.texels[size_t(std::clamp<int64_t>(row, 0, h - 1) * w + (column % w + w) % w)];
    };
    const float across = float(x - double(left)), down = float(y - double(upper));
    return glm::mix(glm::mix(read(left, upper), read(left + 1, upper), across), glm::mix(read(left, upper + 1), read(left + 1, upper + 1), across), down);
}

}  // namespace myriad::reference
