#include "passes/filter/filter_ref.hpp"

#include <algorithm>
#include <cmath>

namespace myriad::passes {

using glm::dvec3;

// The window is a box, k pixels wide, on the pixel's middle: what it covers of a neighbour is that neighbour's weight.
static double covered(double offset, double k) { return std::clamp(0.5 + k / 2 - std::abs(offset), 0.0, 1.0); }

std::vector<dvec3> filter_ref(const HostGBuffer& g, const std::vector<vec4>& irradiance, uint block, double pixel_angle) {
    std::vector<dvec3> out(irradiance.size(), dvec3(0));
    for (size_t i = 0; i < g.pixels(); ++i) {
        if (!g.hit(i)) continue;
        double total = 0, mirrored_total = 0;
        const GlossRef gloss = g.gloss_ref(i);
        // As seen from where this pixel is.
        const auto share = [&](const GlossRef& of) {
            const double nv = g.gloss.empty() ? 1 : std::clamp(dot(dvec3(g.shading(i)), dvec3(g.lobe(i).view)), 1e-4, 1.0);
            const double even = (brdf_fitted_ref(of.roughness, nv) - 0.04) / 0.96;
            return glm::max(of.f0 + (1.0 - of.f0) * even, dvec3(1e-3));
        };
        const double window = double(block) * pixel_angle * double(g.positions[i].w);
        for (size_t j = 0; j < g.pixels(); ++j) {
            const double dx = double(j % g.width) - double(i % g.width), dy = double(j / g.width) - double(i / g.width);
            if (!g.hit(j) || covered(dx, block) * covered(dy, block) == 0) continue;
            const double alike = std::pow(std::max(dot(dvec3(g.shading(i)), dvec3(g.shading(j))), 0.0), 16);
            const double off = dot(dvec3(g.geometric(i)), dvec3(g.position(j)) - dvec3(g.position(i))) / window;
            const double w = covered(dx, block) * covered(dy, block) * alike * std::pow(std::max(1 - off * off, 0.0), 2);
            out[i] += w * dvec3(irradiance[j]);
            total += w;
            const GlossRef other = g.gloss_ref(j);
            if (gloss.roughness == 0 || other.roughness == 0) continue;
            const double l = w * std::pow(std::max(1 - std::pow((gloss.roughness - other.roughness) / 0.25, 2), 0.0), 2);
            out[g.pixels() + i] += l * dvec3(irradiance[g.pixels() + j]) / share(other) * share(gloss);
            mirrored_total += l;
        }
        out[i] /= total;
        if (mirrored_total > 0) out[g.pixels() + i] /= mirrored_total;
    }
    return out;
}

}  // namespace myriad::passes
