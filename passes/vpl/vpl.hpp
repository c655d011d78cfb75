// Virtual point lights of all kinds of lights, and a view for each; see README.md.
#pragma once

#include "compute/raytrace/bvh.hpp"
#include "compute/scan/scan.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/vpl/vpl_io.h"

namespace myriad::passes {

class VplPass {
public:
    // At most `max_vpls` VPLs, 1 to 2^24.
    VplPass(engine::Device& device, uint32_t max_vpls);

    // How many VPLs a path may leave: one a bounce, and one on the emitter where there are emissive triangles.
    static uint32_t vpls_a_path(const LightTable& lights, uint32_t bounces) { return bounces + lights.has_emissive(); }
    // How many light paths fit, max_vpls / vpls_a_path. Throws InputError when there is light but no path fits.
    uint32_t paths(const LightTable& lights, uint32_t bounces) const;

    // `bounces`: reflections a path makes, at most vpl_max_bounces. The pattern depends on `seed` and nothing else.
    void record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                uint32_t bounces, uint32_t seed);

    // The first count()[0] elements; the rest is undefined.
    const engine::Array<Vpl>& vpls() const { return vpls_; }
    const engine::Array<View>& views() const { return views_; }
    const engine::Array<uint>& count() const { return count_; }
    // [0] != 0: a ray's walk met the device's limit on loops (trace.glsl), and the result cannot be trusted.
    const engine::Array<uint>& exhausted() const { return exhausted_; }
    uint32_t max_vpls() const { return uint32_t(vpls_.count()); }

private:
    engine::Program emit_, bounce_, compact_;
    engine::Array<Vpl> slots_, vpls_;
    engine::Array<uint> alive_, slot_count_, count_, exhausted_;
    engine::Array<View> views_;
    compute::Scan scan_;
};

}  // namespace myriad::passes
