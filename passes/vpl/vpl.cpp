#include "passes/vpl/vpl.hpp"

#include <bit>

#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {

using engine::passes_kernels;

VplPass::VplPass(engine::Device& device, uint32_t max_vpls)
    : emit_(device, passes_kernels, "vpl/emit"), bounce_(device, passes_kernels, "vpl/bounce"),
      compact_(device, passes_kernels, "vpl/compact"), slots_(device, "vpls", "VPL slots", max_vpls),
      vpls_(device, "vpls", "VPLs", max_vpls), alive_(device, "vpls", "VPL slots alive", max_vpls + 1),
      slot_count_(engine::upload(device, "vpls", "VPL slot count", std::vector<uint>{max_vpls})),
      count_(device, "vpls", "VPL count", 1), exhausted_(device, "vpls", "VPL paths exhausted", 1),
       views_(device, "vpls", "VPL views", max_vpls), scan_(device, max_vpls) {
    // Above, path_selection would tell neighbouring paths apart no more.
    assert(max_vpls >= 1 && max_vpls <= 1u << 24);
}

uint32_t VplPass::paths(const LightTable& lights, uint32_t bounces) const {
    const uint32_t each = vpls_a_path(lights, bounces);
    if (!(lights.power() > 0) || each == 0) return 0;
    if (max_vpls() < each)
        throw InputError(std::to_string(max_vpls()) + " VPLs do not hold one light path of " + std::to_string(bounces) +
                         " bounces; give --vpls " + std::to_string(each) + " or more, or fewer --bounces.");
    return max_vpls() / each;
}

void VplPass::record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                     uint32_t bounces, uint32_t seed) {
    assert(bounces <= vpl_max_bounces);
    const uint32_t paths = this->paths(lights, bounces), layers = vpls_a_path(lights, bounces);
    const uint32_t first_hits = lights.has_emissive();  // the layer above the emitters' own, if they have one
    recorder.fill(exhausted_, 0);
    if (paths == 0) {
        recorder.fill(count_, 0);
        return;
    }
    const auto on_layer = [&](uint32_t layer) {
        return VplPaths{.geometry = geometry.read(recorder), .bvh = bvh.read(recorder), .slots = recorder.write(slots_),
                        .alive = recorder.write(alive_), .exhausted = recorder.write(exhausted_), .paths = paths, .path_bits = uint(std::bit_width(paths - 1)),
                        .seed = seed, .layer = layer};
    };
    recorder.fill(alive_, 0);
    recorder.dispatch(emit_,
                      VplEmitPush{.on = on_layer(first_hits), .lights = lights.read(recorder), .light_count = lights.count(),
                                  .layers = layers},
                      paths);
    for (uint32_t layer = 1; layer < layers; ++layer) recorder.dispatch(bounce_, VplBouncePush{.on = on_layer(layer)}, paths);

    scan_.record(recorder, alive_, slot_count_);
    recorder.dispatch(compact_,
                      VplCompactPush{.slots = recorder.read(slots_), .offsets = recorder.read(alive_), .vpls = recorder.write(vpls_),
                                     .views = recorder.write(views_), .count = recorder.write(count_), .slot_count = max_vpls()},
                      max_vpls());
}

}  // namespace myriad::passes
