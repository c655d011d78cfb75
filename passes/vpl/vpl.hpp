// Virtual point lights of all kinds of lights, and a view for each; see README.md.
#pragma once

#include <optional>

#include "compute/raytrace/bvh.hpp"
#include "compute/scan/scan.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/vpl/guide.hpp"
#include "passes/vpl/vpl_io.h"

namespace myriad::passes {

class VplPass {
public:
    // At most `max_vpls` VPLs, 1 to 2^24.
    VplPass(engine::Device& device, uint32_t max_vpls, const engine::Constants& variant = {});

    // How many VPLs a path may leave: one a bounce, and one on the emitter where there are emissive triangles.
    static uint32_t vpls_a_path(const LightTable& lights, uint32_t bounces) { return bounces + lights.has_emissive(); }
    // How many light paths fit whatever they meet, max_vpls / vpls_a_path. Throws InputError when there is light but no path
    // fits.
    uint32_t sure_paths(const LightTable& lights, uint32_t bounces) const;

    // Once a scene, before frames: guides emission by a pilot, and finds how many paths leave close to max_vpls VPLs and no
    // more. Submits what is recorded, and some trials. Throws InputError as above, OutOfMemory.
    void prepare(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                 uint32_t bounces, uint32_t seed);

    // `bounces`: reflections a path makes, at most vpl_max_bounces. The pattern depends on `seed` and on what was prepared.
    // Prepared: with the same arguments, and where the scene has moved since, perhaps more VPLs than fit (see count).
    // Not prepared: by power alone, sure_paths of them.
    void record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                uint32_t bounces, uint32_t seed);

    // The first count()[0] elements; the rest is undefined.
    const engine::Array<Vpl>& vpls() const { return vpls_; }
    const engine::Array<View>& views() const { return views_; }
    // [1]: how many there would be with room for all. Where that is more, the scene changed, and prepare() is due again.
    const engine::Array<uint>& count() const { return count_; }
    // [0] != 0: a ray's walk met the device's limit on loops (trace.glsl), and the result cannot be trusted.
    const engine::Array<uint>& exhausted() const { return exhausted_; }
    uint32_t max_vpls() const { return uint32_t(vpls_.count()); }
    uint32_t prepared_paths() const { return paths_; }
    const EmissionGuide* guide() const { return guide_ ? &*guide_ : nullptr; }

private:
    void make_slots(uint64_t slots);
    void record_paths(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                      uint32_t bounces, uint32_t seed, uint32_t paths);

    engine::Device& device_;
    engine::Constants variant_;
    engine::Program emit_, emit_guided_, bounce_, compact_;
    engine::Array<Vpl> slots_, vpls_;
    engine::Array<uint> alive_, slot_count_, count_, exhausted_;
    engine::Array<View> views_;
    std::optional<compute::Scan> scan_;
    // Prepared.
    std::optional<EmissionGuide> guide_;
    uint32_t paths_ = 0, bounces_ = 0, seed_ = 0;
};

}  // namespace myriad::passes
