// Virtual point lights of all kinds of lights, and a view for each; see README.md.
#pragma once

#include <array>
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

    // `bounces`: reflections a path makes, at most vpl_max_bounces. The pattern depends on `seed` and on what was prepared, so each VPL
    // is the same vertex of the same path in all frames, wherever lights and surfaces have moved.
    // Prepared: with the same arguments, and where the scene has moved since, perhaps more VPLs than fit (see count).
    // Not prepared: by power alone, sure_paths of them.
    void record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                uint32_t bounces, uint32_t seed);

    // The first count()[0] elements; the rest is undefined. An element is the same VPL frame after frame. One that is dead, since its
    // path goes another way now, has no flux, and its view sees nothing (vpl_of_nothing); a newborn one may take its place for good.
    const engine::Array<Vpl>& vpls() const { return vpls_; }
    const engine::Array<View>& views() const { return views_; }
    // [0]: elements; [1]: of which alive; [2]: VPLs for which there was no room. Where that is not 0, the scene changed, and prepare()
    // is due again.
    const engine::Array<uint>& count() const { return count_; }
    // By element, dead or alive: which path's which vertex it is, an index of the two below.
    const engine::Array<uint>& owners() const { return owners_; }
    // The last frame's paths (VplPaths): VPLs, and whether there is one.
    const engine::Array<Vpl>& slots() const { return slots_; }
    const engine::Array<uint>& alive() const { return alive_; }
    // [0] != 0: a ray's walk met the device's limit on loops (trace.glsl), and the result cannot be trusted.
    const engine::Array<uint>& exhausted() const { return exhausted_; }
    uint32_t max_vpls() const { return uint32_t(vpls_.count()); }
    uint32_t prepared_paths() const { return paths_; }
    const EmissionGuide* guide() const { return guide_ ? &*guide_ : nullptr; }

private:
    void make_slots(uint64_t slots);
    void forget_places(engine::Recorder& recorder);
    void record_paths(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                      uint32_t bounces, uint32_t seed, uint32_t paths);

    engine::Device& device_;
    engine::Constants variant_;
    engine::Program emit_, emit_guided_, bounce_, ask_, vacate_, settle_;
    engine::Array<Vpl> slots_, vpls_;
    engine::Array<uint> alive_, flags_, flag_count_, places_, owners_, vacant_, count_, exhausted_;
    engine::Array<View> views_;
    std::optional<compute::Scan> scan_;
    std::array<uint32_t, 4> pattern_{};  // what slots mean: while it stays, VPLs keep their places
    // Prepared.
    std::optional<EmissionGuide> guide_;
    uint32_t paths_ = 0, bounces_ = 0, seed_ = 0;
};

}  // namespace myriad::passes
