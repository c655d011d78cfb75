// Closest hits and occlusion of lists of rays: what tests and benches call. Renderers call trace.glsl in their own kernels.
#pragma once

#include "compute/raytrace/bvh.hpp"

namespace myriad::compute {

class RayQuery {
public:
    RayQuery(engine::Device& device, const Bvh& bvh);

    // For this tree only, since kernels are specialised by it. `hits` and `occluded` hold an element a ray. `status[0]`, which the
    // caller has cleared, becomes 1 when a ray met the device's loop limit; its result is then void.
    void closest(engine::Recorder& recorder, const Bvh& bvh, const engine::Array<Ray>& rays, const engine::Array<RayHitRecord>& hits,
                 const engine::Array<uint>& status);
    void occluded(engine::Recorder& recorder, const Bvh& bvh, const engine::Array<Ray>& rays, const engine::Array<uint>& occluded,
                  const engine::Array<uint>& status);

private:
    engine::Program closest_, occluded_;
};

}  // namespace myriad::compute
