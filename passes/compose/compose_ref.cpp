#include "passes/compose/compose_ref.hpp"

#include <numbers>

namespace myriad::passes {

using glm::dvec3;

std::vector<ComposedRef> compose_ref(const HostGBuffer& gbuffer, const std::vector<vec4>* irradiance, const std::vector<vec4>* natural,
                                     const std::vector<vec4>* direct, const std::vector<vec4>* lamps, const std::vector<vec4>* beyond) {
    std::vector<ComposedRef> out;
    for (size_t i = 0; i < gbuffer.pixels(); ++i) {
        dvec3 indirect(0);
        for (const std::vector<vec4>* light : {irradiance, natural}) {
            if (!light) continue;
            indirect += dvec3(gbuffer.albedo[i]) * dvec3((*light)[i]) / std::numbers::pi;
            if (!gbuffer.gloss.empty()) indirect += dvec3((*light)[gbuffer.pixels() + i]);
        }
        if (beyond) indirect += dvec3(gbuffer.albedo[i]) * dvec3((*beyond)[i]) / std::numbers::pi;
        dvec3 light = direct ? dvec3((*direct)[i]) : dvec3(0);
        if (lamps) light += dvec3(gbuffer.albedo[i]) * dvec3((*lamps)[i]) / std::numbers::pi;
        if (lamps && !gbuffer.gloss.empty()) light += dvec3((*lamps)[gbuffer.pixels() + i]);
        out.push_back({indirect, dvec3(gbuffer.emitted[i]) + indirect + light, light});
    }
    return out;
}

}  // namespace myriad::passes
