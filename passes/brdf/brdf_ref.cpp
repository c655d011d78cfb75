#include "passes/brdf/brdf_ref.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace myriad::passes {

using glm::dvec3;
using std::numbers::pi;

namespace {

double p(double roughness) { return 0.96 * std::pow(1 - roughness, 4); }
double q(double roughness) { return 3 * roughness * std::pow(1 - roughness, 3) + 0.03; }

}  // namespace

double brdf_fitted_ref(double roughness, double cosine) {
    return 0.04 + p(roughness) * std::pow(1 - cosine, 5) + q(roughness) * std::pow(1 - cosine, 3);
}

BrdfRef brdf_ref(const GlossRef& gloss, const dvec3& normal, const dvec3& view, const dvec3& light, double widen) {
    if (gloss.roughness == 0) return {1 / pi, 0, dvec3(0)};
    // Of unit length in floats is not enough here: in a narrow lobe, 1 - cos^2 would feel it.
    const dvec3 n = glm::normalize(normal), v = glm::normalize(view), l = glm::normalize(light);
    const auto cosine = [&](const dvec3& d) { return std::clamp(glm::dot(n, d), 1e-4, 1.0); };
    const double nv = cosine(v), nl = cosine(l), r = gloss.roughness;
    const double alpha2 = std::min(std::pow(r, 4) + widen, 1.0);
    const dvec3 h = glm::normalize(l + v);
    const double nh = glm::dot(n, h), vh = glm::dot(v, h);
    const double d = alpha2 / (pi * std::pow(nh * nh * (alpha2 - 1) + 1, 2));
    const double lambda_v = std::sqrt(alpha2 + (1 - alpha2) * nv * nv), lambda_l = std::sqrt(alpha2 + (1 - alpha2) * nl * nl);
    const double visibility = 0.5 / (nl * lambda_v + nv * lambda_l);
    const dvec3 fresnel = gloss.f0 + (1.0 - gloss.f0) * std::pow(1 - std::abs(vh), 5);
    const double mean = 0.04 + p(r) / 21 + q(r) / 10;
    return {(1 - brdf_fitted_ref(r, nl)) * (1 - brdf_fitted_ref(r, nv)) / (1 - mean) / pi, visibility * d, fresnel};
}

}  // namespace myriad::passes
