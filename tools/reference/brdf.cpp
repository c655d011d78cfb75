#include "tools/reference/brdf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace myriad::reference {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float dielectric = 0.04f;       // f0 of an index of refraction of 1.5
constexpr float least_roughness = 0.045f; // see README.md
constexpr float matte_roughness = 0.9f;
constexpr float least_cosine = 1e-4f;     // of a view along the surface: cosines divide

float fifth(float x) { return x * x * x * x * x; }

vec3 fresnel(const vec3& f0, float cosine) { return f0 + (1.0f - f0) * fifth(1 - std::min(cosine, 1.0f)); }

float luminance(const vec3& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

// What the lobe of a dielectric reflects: the mean, over visible facets, of Fresnel's share times what is not masked on the way out.
double lobe_albedo(float cosine, float roughness) {
    const float alpha = roughness * roughness;
    const vec3 view(std::sqrt(1 - cosine * cosine), 0, cosine);
    constexpr int steps = 24;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const vec3 half = visible_facet(view, alpha, {(float(i) + 0.5f) / steps, (float(j) + 0.5f) / steps});
            const float along = glm::dot(view, half);
            const float out = 2 * along * half.z - view.z;
            if (along > 0 && out > 0) sum += double(fresnel(vec3(dielectric), along).x * masking(cosine, out, alpha) / masking(cosine, alpha));
        }
    return sum / (steps * steps);
}

}  // namespace

float facets(const vec3& h, float alpha) {
    const float stretched = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;  // of sines, which narrow lobes need
    return 1 / (pi * alpha * alpha * stretched * stretched);
}

// 1 / (1 + lambda), lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2.
float masking(float cosine, float alpha) {
    const float a2 = alpha * alpha, c2 = cosine * cosine;
    return 2 * cosine / (cosine + std::sqrt(c2 + a2 * (1 - c2)));
}

float masking(float cosine, float other, float alpha) {
    const float a2 = alpha * alpha;
    return 2 * cosine * other /
           (other * std::sqrt(cosine * cosine + a2 * (1 - cosine * cosine)) + cosine * std::sqrt(other * other + a2 * (1 - other * other)));
}

vec3 visible_facet(const vec3& view, float alpha, const vec2& x) {
    const vec3 stretched = glm::normalize(vec3(alpha * view.x, alpha * view.y, view.z));
    const float flat = stretched.x * stretched.x + stretched.y * stretched.y;
    const vec3 across = flat > 0 ? vec3(-stretched.y, stretched.x, 0) / std::sqrt(flat) : vec3(1, 0, 0);
    const vec3 up = glm::cross(stretched, across);
    const float r = std::sqrt(x.x), turn = 2 * pi * x.y, s = 0.5f * (1 + stretched.z);
    const float t1 = r * std::cos(turn), t2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - t1 * t1)) + s * r * std::sin(turn);
    const vec3 h = t1 * across + t2 * up + std::sqrt(std::max(0.0f, 1 - t1 * t1 - t2 * t2)) * stretched;
    return glm::normalize(vec3(alpha * h.x, alpha * h.y, std::max(1e-6f, h.z)));  // 1e-6: a facet that stands upright has a direction, too
}

void complete_frame(const vec3& n, vec3& x, vec3& y) {
    const float side = std::copysign(1.0f, n.z), a = -1 / (side + n.z), b = n.x * n.y * a;
    x = {1 + side * n.x * n.x * a, side * b, -side * n.x};
    y = {b, side + n.y * n.y * a, -n.y};
}

vec3 cosine_direction(const vec2& x) {
    const float r = std::sqrt(x.x), turn = 2 * pi * x.y;
    return {r * std::cos(turn), r * std::sin(turn), std::sqrt(1 - x.x)};
}

const Albedos& Albedos::all() {
    static const Albedos albedos;
    return albedos;
}

Albedos::Albedos() : table_(size_t(roughnesses * cosines)), means_(roughnesses) {
    for (int i = 0; i < roughnesses; ++i) {
        const float roughness = std::max(float(i) / (roughnesses - 1), least_roughness);
        for (int j = 0; j < cosines; ++j)
            table_[size_t(i * cosines + j)] = float(lobe_albedo(std::max(float(j) / (cosines - 1), least_cosine), roughness));
        constexpr int steps = 1024;
        double sum = 0;
        for (int k = 0; k < steps; ++k) sum += 2 * (k + 0.5) / steps * double(row(i, (float(k) + 0.5f) / steps));
        means_[size_t(i)] = float(sum / steps);
    }
}

float Albedos::row(int i, float cosine) const {
    const float at = std::clamp(cosine, 0.0f, 1.0f) * (cosines - 1);
    const int low = std::min(int(at), cosines - 2);
    return glm::mix(table_[size_t(i * cosines + low)], table_[size_t(i * cosines + low + 1)], at - float(low));
}

float Albedos::at(float cosine, float roughness) const {
    const float at = std::clamp(roughness, 0.0f, 1.0f) * (roughnesses - 1);
    const int low = std::min(int(at), roughnesses - 2);
    return glm::mix(row(low, cosine), row(low + 1, cosine), at - float(low));
}

float Albedos::mean(float roughness) const {
    const float at = std::clamp(roughness, 0.0f, 1.0f) * (roughnesses - 1);
    const int low = std::min(int(at), roughnesses - 2);
    return glm::mix(means_[size_t(low)], means_[size_t(low + 1)], at - float(low));
}

Brdf::Brdf(const Surface& s, const vec3& view, Model model) : z_(s.shading), geometric_(s.geometric) {
    complete_frame(z_, x_, y_);
    view_ = local(view);
    view_.z = std::max(view_.z, least_cosine);
    diffuse_ = s.base * (1 - s.metallic);
    const bool matte = !(s.metallic > 0) && s.roughness >= matte_roughness;
    if (model == Model::diffuse || matte || s.unlit) return;
    glossy_ = true;
    roughness_ = std::max(s.roughness, least_roughness);
    alpha_ = roughness_ * roughness_;
    f0_ = glm::mix(vec3(dielectric), s.base, s.metallic);
    const Albedos& albedos = Albedos::all();
    const float reflected = albedos.at(view_.z, roughness_);
    under_ = (1 - reflected) / (1 - albedos.mean(roughness_));
    // Lobes are chosen by about what they reflect of even light.
    const float glossy = luminance(f0_ + (1.0f - f0_) * std::max(0.0f, reflected - dielectric) / (1 - dielectric));
    const float below = luminance(diffuse_) * (1 - reflected);
    choose_glossy_ = diffuse_ == vec3(0) ? 1 : std::clamp(glossy / (glossy + below), 0.1f, 0.9f);
}

vec3 Brdf::times_cosine(const vec3& l) const {
    const vec3 light = local(l);
    if (!(light.z > 0) || !(glm::dot(l, geometric_) > 0)) return vec3(0);
    if (!glossy_) return diffuse_ * (light.z / pi);
    const vec3 half = unit_or(light + view_, vec3(0, 0, 1));
    const vec3 mirrored = fresnel(f0_, glm::dot(view_, half)) * (facets(half, alpha_) * masking(light.z, view_.z, alpha_) / (4 * view_.z));
    return mirrored + diffuse_ * ((1 - Albedos::all().at(light.z, roughness_)) * under_ * light.z / pi);
}

float Brdf::density(const vec3& l) const {
    const vec3 light = local(l);
    if (!(light.z > 0)) return 0;
    const float by_cosine = light.z / pi;
    if (!glossy_) return by_cosine;
    const vec3 half = unit_or(light + view_, vec3(0, 0, 1));
    const float by_lobe = facets(half, alpha_) * masking(view_.z, alpha_) / (4 * view_.z);
    return glm::mix(by_cosine, by_lobe, choose_glossy_);
}

Brdf::Sample Brdf::sample(float choice, const vec2& x) const {
    vec3 l;
    if (choice < choose_glossy_) {
        const vec3 half = visible_facet(view_, alpha_, x);
        l = world(glm::normalize(2 * glm::dot(view_, half) * half - view_));
    } else {
        l = world(cosine_direction(x));
    }
    const vec3 f = times_cosine(l);
    const float p = density(l);
    if (f == vec3(0) || !(p > 0)) return {l, vec3(0), 0};
    return {l, f / p, p};
}

}  // namespace myriad::reference
