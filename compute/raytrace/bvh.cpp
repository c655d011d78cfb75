#include "compute/raytrace/bvh.hpp"

#include "engine/transfer.hpp"

namespace myriad::compute {

Bvh::Bvh(engine::Device& device, const WorldTriangles& world, const BvhParts& tree, OpacityReader opacity)
    : nodes_(engine::upload(device, "scene", "BVH nodes", tree.nodes)), triangles_(engine::upload(device, "scene", "BVH triangles", tree.triangles)),
      instances_(engine::upload(device, "scene", "BVH instances", tree.instances)), triangle_count_(tree.triangles.size()), dropped_(tree.dropped),
      shared_(world.shared()), depth_(tree.depth),
      // A quarter stays for the loops of the kernel around the traversal.
      loop_budget_(device.loop_limit() - device.loop_limit() / 4) {
    assert(!tree.asks || opacity);
    if (tree.asks) opacity_ = std::move(opacity);
}

engine::Constants Bvh::constants(engine::Constants own) const {
    own[instanced_constant] = shared_;
    own[trace_asks_constant] = asks();
    return own;
}

BvhRef Bvh::read(engine::Recorder& recorder) const {
    return {.nodes = recorder.read(nodes_),
            .triangles = recorder.read(triangles_),
            .instances = instances_.count() ? recorder.read(instances_) : Instances{},
            .opacity = opacity_ ? opacity_(recorder) : OpacityRef{},
            .loop_budget = loop_budget_,
            .padding = 0};
}

}  // namespace myriad::compute
