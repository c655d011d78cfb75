#include "passes/compose/compose_ref.hpp"

#include <numbers>

namespace myriad::passes {

using glm::dvec3;

std::vector<ComposedRef> compose_ref(const HostGBuffer& gbuffer, const std::vector<vec4>* irradiance, const std::vector<vec4>* direct) {
    std::vector<ComposedRef> out;
    for (size_t i = 0; i < gbuffer.pixels(); ++i) {
        dvec3 indirect = irradiance ? dvec3(gbuffer.albedo[i]) * dvec3((*irradiance)[i]) / std::numbers::pi : dvec3(0);
        if (irradiance && !gbuffer.gloss.empty()) indirect += dvec3((*irradiance)[gbuffer.pixels() + i]);
        out.push_back({indirect, dvec3(gbuffer.emitted[i]) + indirect + (direct ? dvec3((*direct)[i]) : dvec3(0))});
    }
    return out;
}

}  // namespace myriad::passes
