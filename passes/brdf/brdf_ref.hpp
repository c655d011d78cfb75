// The plain twin of brdf.h, in doubles and in the words of glTF 2.0's Appendix B. Tests only.
#pragma once
#include <glm/glm.hpp>
namespace myriad::passes {
struct GlossRef {
    glm::dvec3 f0{0};
    double roughness = 0;  // 0: matte
};
// What multiplies the diffuse albedo, and what Fresnel's share; both in 1/sr.
struct BrdfRef {
    double diffuse = 0, glossy = 0;
    glm::dvec3 fresnel{0};
};
// `widen` adds to alpha^2 = roughness^4.
BrdfRef brdf_ref(const GlossRef& gloss, const glm::dvec3& n, const glm::dvec3& v, const glm::dvec3& l, double widen = 0);
// A dielectric's reflectance by the fit of brdf.h.
double brdf_fitted_ref(double roughness, double cosine);
}  // namespace myriad::passes
