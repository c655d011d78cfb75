#include "compute/raytrace/bvh.hpp"

#include "engine/transfer.hpp"

namespace myriad::compute {

Bvh::Bvh(engine::Device& device, std::span<const glm::vec3> positions, std::span<const glm::uvec4> triangles, BvhQuality quality)
    // A quarter stays for the loops of the kernel around the traversal.
    : loop_budget_(device.loop_limit() - device.loop_limit() / 4) {
    const auto start = std::chrono::steady_clock::now();
    const BvhData data = build_bvh(positions, triangles, quality);
    build_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    nodes_ = engine::upload(device, "scene", "BVH nodes", data.nodes);
    triangles_ = engine::upload(device, "scene", "BVH triangles", data.triangles);
    triangle_count_ = data.triangles.size();
    dropped_ = data.dropped;
    depth_ = data.depth;
}

BvhRef Bvh::read(engine::Recorder& recorder) const {
    return {.nodes = recorder.read(nodes_), .triangles = recorder.read(triangles_), .loop_budget = loop_budget_, .padding = 0};
}

}  // namespace myriad::compute
