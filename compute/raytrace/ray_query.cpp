#include "compute/raytrace/ray_query.hpp"

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

RayQuery::RayQuery(engine::Device& device, const Bvh& bvh)
    : closest_(device, compute_kernels, "raytrace/closest", bvh.constants()),
      occluded_(device, compute_kernels, "raytrace/occluded", bvh.constants()) {}

void RayQuery::closest(engine::Recorder& recorder, const Bvh& bvh, const engine::Array<Ray>& rays, const engine::Array<RayHitRecord>& hits,
                       const engine::Array<uint>& status) {
    assert(hits.count() >= rays.count());
    recorder.dispatch(closest_,
                      RayQueryPush{.bvh = bvh.read(recorder), .rays = recorder.read(rays), .hits = recorder.write(hits),
                                   .status = recorder.write(status), .count = uint(rays.count())},
                      rays.count());
}

void RayQuery::occluded(engine::Recorder& recorder, const Bvh& bvh, const engine::Array<Ray>& rays, const engine::Array<uint>& occluded,
                        const engine::Array<uint>& status) {
    assert(occluded.count() >= rays.count());
    recorder.dispatch(occluded_,
                      RayQueryPush{.bvh = bvh.read(recorder), .rays = recorder.read(rays), .occluded = recorder.write(occluded),
                                   .status = recorder.write(status), .count = uint(rays.count())},
                      rays.count());
}

}  // namespace myriad::compute
