#include "passes/compose/compose_ref.hpp"

#include <numbers>

namespace myriad::passes {

using glm::dvec3;

std::vector<ComposedRef> compose_ref(const HostGBuffer& gbuffer, const std::vector<vec4>* irradiance, const std::vector<vec4>* direct) {
    std::vector<ComposedRef> out;
    for (size_t i = 0; i < gbuffer.pixels(); ++i) {
        const dvec3 indirect = irradiance ? dvec3(gbuffer.albedo[i]) * dvec3((*irradiance)[i]) / std::numbers::pi : dvec3(0);
        out.push_back({indirect, dvec3(gbuffer.emitted[i]) + indirect + (direct ? dvec3((*direct)[i]) : dvec3(0))});
    }
    return out;
}

}  // namespace myriad::passes
