#include "passes/vpl/vpl.hpp"

#include <algorithm>
#include <bit>

#include "engine/transfer.hpp"
#include "passes/kernels.hpp"
#include "passes/vpl/vpl_sampling.h"

namespace myriad::passes {

using engine::passes_kernels;

namespace {

constexpr uint32_t path_limit = 1u << 24;  // above, path_selection would tell neighbouring paths apart no more
constexpr uint64_t most_paths = 8;         // a VPL that is asked for: the patience with light that misses everything
constexpr uint64_t most_slots = 16;        // likewise, which bounds memory where there are many bounces
constexpr double fill = 0.98;              // of what is asked for is aimed at, for the next seed may find a little more

engine::Constants guided(engine::Constants variant) {
    variant[2] = 1;  // emit.comp
    return variant;
}

}  // namespace

VplPass::VplPass(engine::Device& device, uint32_t max_vpls, const engine::Constants& variant)
    : device_(device), variant_(variant), emit_(device, passes_kernels, "vpl/emit", variant),
      emit_guided_(device, passes_kernels, "vpl/emit", guided(variant)), bounce_(device, passes_kernels, "vpl/bounce", variant),
      ask_(device, passes_kernels, "vpl/ask"), vacate_(device, passes_kernels, "vpl/vacate"), settle_(device, passes_kernels, "vpl/settle"),
      vpls_(device, "vpls", "VPLs", max_vpls), owners_(device, "vpls", "VPL owners", max_vpls),
      vacant_(device, "vpls", "VPL places that are vacant", max_vpls), count_(device, "vpls", "VPL count", 4),
      exhausted_(device, "vpls", "VPL paths exhausted", 1), views_(device, "vpls", "VPL views", max_vpls) {
    assert(max_vpls >= 1 && max_vpls <= path_limit);
    make_slots(max_vpls);
}

void VplPass::make_slots(uint64_t slots) {
    if (slots <= slots_.count()) return;
    slots_ = {}, alive_ = {}, flags_ = {}, places_ = {}, scan_.reset();  // first, so that memory need not hold both
    alive_ = {device_, "vpls", "VPL slots alive", slots};
    flags_ = {device_, "vpls", "VPL slots without place", 2 * slots + 1};
    places_ = {device_, "vpls", "VPL places", slots};
    flag_count_ = engine::upload(device_, "vpls", "VPL flag count", std::vector<uint>{uint(2 * slots)});
    scan_.emplace(device_, 2 * slots);
    pattern_ = {};
    slots_ = {device_, "vpls", "VPL slots", slots};  // last: where memory ran out, all of it is made again
}

uint32_t VplPass::sure_paths(const LightTable& lights, uint32_t bounces) const {
    const uint32_t each = vpls_a_path(lights, bounces);
    if (!(lights.power() > 0) || each == 0) return 0;
    if (max_vpls() < each)
        throw InputError(std::to_string(max_vpls()) + " VPLs do not hold one light path of " + std::to_string(bounces) +
                         " bounces; give --vpls " + std::to_string(each) + " or more, or fewer --bounces.");
    return max_vpls() / each;
}

void VplPass::prepare(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                      uint32_t bounces, uint32_t seed) {
    const uint32_t sure = sure_paths(lights, bounces);
    paths_ = sure, bounces_ = bounces, seed_ = seed;
    guide_.reset();
    if (sure == 0) return;
    // Neither the guide nor, as a rule, the number of paths knows the points that are used in the end: else the sum of their
    // fluxes, being looked at before it is chosen, would be biased.
    const uint32_t pilot_seed = hash(seed ^ 0x5eedu);
    guide_.emplace(recorder, geometry, bvh, lights, pilot_seed, variant_);
    const auto alive = [&](uint32_t with_seed) {
        make_slots(uint64_t(paths_) * vpls_a_path(lights, bounces));
        {
            auto scope = recorder.scope("vpl trial");
            record_paths(recorder, geometry, bvh, lights, bounces, with_seed, paths_);
        }
        recorder.submit_and_wait();
        const std::vector<uint> count = engine::download(device_, count_);
        return count[1] + count[2];
    };
    const auto scaled = [&](uint32_t found) { return uint64_t(fill * double(paths_) * max_vpls() / std::max(found, 1u)); };
    const uint64_t most = std::min<uint64_t>({most_paths * max_vpls(), most_slots * max_vpls() / vpls_a_path(lights, bounces), path_limit});
    for (int trial = 0; trial < 2; ++trial) paths_ = uint32_t(std::clamp<uint64_t>(scaled(alive(pilot_seed)), sure, most));
    while (paths_ > sure) {
        const uint32_t found = alive(seed);
        if (found <= max_vpls()) break;
        paths_ = uint32_t(std::clamp<uint64_t>(scaled(found), sure, paths_ - 1));
    }
    pattern_ = {};  // trials leave no traces
}

void VplPass::record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                     uint32_t bounces, uint32_t seed) {
    assert(!guide_ || (bounces == bounces_ && seed == seed_));
    if (guide_) guide_->follow(lights);
    record_paths(recorder, geometry, bvh, lights, bounces, seed, guide_ ? paths_ : sure_paths(lights, bounces));
}

void VplPass::record_paths(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                           uint32_t bounces, uint32_t seed, uint32_t paths) {
    assert(bounces <= vpl_max_bounces);
    const uint32_t layers = vpls_a_path(lights, bounces);
    const uint32_t first_hits = lights.has_emissive();  // the layer above the emitters' own, if they have one
    recorder.fill(exhausted_, 0);
    if (const std::array<uint32_t, 4> pattern{paths, bounces, layers, seed}; paths == 0 || pattern != pattern_) {
        forget_places(recorder);
        pattern_ = pattern;
    }
    if (paths == 0) return;
    const auto on_layer = [&](uint32_t layer) {
        return VplPaths{.geometry = geometry.read(recorder), .bvh = bvh.read(recorder), .slots = recorder.write(slots_),
                        .alive = recorder.write(alive_), .exhausted = recorder.write(exhausted_), .paths = paths,
                        .path_bits = uint(std::bit_width(paths - 1)), .seed = seed, .layer = layer};
    };
    recorder.fill(alive_, 0);
    recorder.dispatch(guide_ ? emit_guided_ : emit_,
                      VplEmitPush{.on = on_layer(first_hits), .lights = lights.read(recorder), .shares = guide_ ? guide_->shares(recorder) : Floats{},
                                  .cells = guide_ ? guide_->cells(recorder) : Floats{}, .light_count = lights.count(),
                                  .guided_layers = (guide_ ? lights.data().guided() : 0) << 8 | layers},
                      paths);
    for (uint32_t layer = 1; layer < layers; ++layer) recorder.dispatch(bounce_, VplBouncePush{.on = on_layer(layer)}, paths);

    const auto places = [&] {
        return VplPlacesPush{.slots = recorder.read(slots_), .alive = recorder.read(alive_), .flags = recorder.write(flags_),
                             .places = recorder.write(places_), .owners = recorder.write(owners_), .vacant = recorder.write(vacant_),
                             .vpls = recorder.write(vpls_), .views = recorder.write(views_), .count = recorder.write(count_),
                             .slot_count = uint(slots_.count()), .max_vpls = max_vpls()};
    };
    recorder.dispatch(ask_, places(), slots_.count());
    scan_->record(recorder, flags_, flag_count_);
    recorder.dispatch(vacate_, places(), slots_.count());
    recorder.dispatch(settle_, places(), slots_.count());
}

// Then the living get places in the order of slots.
void VplPass::forget_places(engine::Recorder& recorder) {
    recorder.fill(places_, 0);
    recorder.fill(owners_, vpl_nobody);
    recorder.fill(count_, 0);
}

}  // namespace myriad::passes
