#include "passes/deform/deform.hpp"

#include <algorithm>
#include <cstring>

#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {

using engine::passes_kernels;

DeformPass::DeformPass(engine::Device& device, const scenes::Motion& motion)
    : deform_(device, passes_kernels, "deform/deform"), flat_(device, passes_kernels, "deform/flat"), first_vertex_(motion.first_vertex),
      vertices_(engine::upload(device, "scene", "moving vertices", motion.vertices)),
      influences_(engine::upload(device, "scene", "influences", motion.influences)),
      deltas_(engine::upload(device, "scene", "morph deltas", motion.deltas)),
      tangents_(engine::upload(device, "scene", "tangents at rest", motion.tangents)),
      flat_triangles_(engine::upload(device, "scene", "flat triangles that move", motion.flat)),
      matrices_(device, "scene", "matrices", motion.matrices.size()),
      host_matrices_(device, "scene", "matrices to come", motion.matrices.size(), engine::Location::host),
      weights_(device, "scene", "morph weights", motion.weights.size()),
      host_weights_(device, "scene", "morph weights to come", motion.weights.size(), engine::Location::host) {
    assert(motion.count() > 0);
}

bool DeformPass::differs(const scenes::Moment& moment) const {
    const auto same = [](const auto& values, const auto& held) {
        return values.empty() || std::memcmp(values.data(), held.span().data(), values.size() * sizeof(values[0])) == 0;
    };
    return !placed_ || !same(moment.matrices, host_matrices_) || !same(moment.weights, host_weights_);
}

void DeformPass::record(engine::Recorder& recorder, const Geometry& geometry, const scenes::Moment& moment) {
    assert(moment.matrices.size() == matrices_.count() && moment.weights.size() == weights_.count());
    placed_ = true;
    std::copy(moment.matrices.begin(), moment.matrices.end(), host_matrices_.span().begin());
    std::copy(moment.weights.begin(), moment.weights.end(), host_weights_.span().begin());
    if (matrices_.count()) recorder.copy(host_matrices_, matrices_, matrices_.bytes());
    if (weights_.count()) recorder.copy(host_weights_, weights_, weights_.bytes());
    const bool has_tangents = tangents_.count() > 0 && geometry.tangents().count() > 0;
    recorder.dispatch(deform_,
                      DeformPush{.vertices = recorder.read(vertices_), .influences = recorder.read(influences_), .deltas = recorder.read(deltas_),
                                 .tangents_at_rest = recorder.read(tangents_),
                                 .tangents = has_tangents ? recorder.write(geometry.tangents(), first_vertex_) : Ref<vec4>{},
                                 .matrices = recorder.read(matrices_), .weights = recorder.read(weights_),
                                 .positions = recorder.write(geometry.positions(), first_vertex_),
                                 .normals = recorder.write(geometry.normals(), first_vertex_), .count = count(), .has_tangents = has_tangents},
                      count());
    recorder.dispatch(flat_,
                      DeformFlatPush{.flat_triangles = recorder.read(flat_triangles_),
                                     .positions = recorder.read(geometry.positions(), first_vertex_),
                                     .normals = recorder.write(geometry.normals(), first_vertex_), .count = uint(flat_triangles_.count())},
                      flat_triangles_.count());
}

}  // namespace myriad::passes
