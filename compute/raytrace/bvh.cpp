#include "compute/raytrace/bvh.hpp"

#include "engine/transfer.hpp"

namespace myriad::compute {

Bvh::Bvh(engine::Device& device, const WorldTriangles& world, BvhQuality quality)
    // A quarter stays for the loops of the kernel around the traversal.
    : shared_(world.shared()), loop_budget_(device.loop_limit() - device.loop_limit() / 4) {
    const auto start = std::chrono::steady_clock::now();
    const BvhData data = build_bvh(world, quality);
    build_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    nodes_ = engine::upload(device, "scene", "BVH nodes", data.nodes);
    triangles_ = engine::upload(device, "scene", "BVH triangles", data.triangles);
    instances_ = engine::upload(device, "scene", "BVH instances", data.instances);
    triangle_count_ = data.triangles.size();
    dropped_ = data.dropped;
    depth_ = data.depth;
}

engine::Constants Bvh::constants(engine::Constants own) const {
    own[instanced_constant] = shared_;
    return own;
}

BvhRef Bvh::read(engine::Recorder& recorder) const {
    return {.nodes = recorder.read(nodes_), .triangles = recorder.read(triangles_),
            .instances = instances_.count() ? recorder.read(instances_) : Instances{}, .loop_budget = loop_budget_, .padding = 0};
}

}  // namespace myriad::compute
