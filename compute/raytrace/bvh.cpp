#include "compute/raytrace/bvh.hpp"

#include "compute/kernels.hpp"
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
    if (!world.moves()) return;
    const BvhMoving found = bvh_moving(world, tree);
    if (!found.nodes.empty()) moving_.emplace(device, found);
}

Bvh::Moving::Moving(engine::Device& device, const BvhMoving& found)
    : move(device, engine::compute_kernels, "raytrace/move"), refit(device, engine::compute_kernels, "raytrace/refit"),
      triangles(engine::upload(device, "scene", "BVH triangles that move", found.triangles)),
      nodes(engine::upload(device, "scene", "BVH nodes that move", found.nodes)),
      boxes(engine::upload(device, "scene", "BVH boxes", found.boxes)), level_ends(found.level_ends) {}

void Bvh::refit(engine::Recorder& recorder, const engine::Array<vec3>& positions, const engine::Array<uvec4>& triangles) {
    if (!moving_) return;
    recorder.dispatch(moving_->move,
                      BvhMovePush{.moving = recorder.read(moving_->triangles), .triangles = recorder.read(triangles),
                                  .positions = recorder.read(positions), .tree = recorder.write(triangles_),
                                  .count = uint(moving_->triangles.count())},
                      moving_->triangles.count());
    uint first = 0;
    for (const uint end : moving_->level_ends) {
        recorder.dispatch(moving_->refit,
                          BvhRefitPush{.nodes = recorder.write(nodes_), .triangles = recorder.read(triangles_),
                                       .boxes = recorder.write(moving_->boxes), .moving = recorder.read(moving_->nodes), .first = first,
                                       .count = end - first},
                          end - first);
        first = end;
    }
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
            .reach = 0};
}

}  // namespace myriad::compute
