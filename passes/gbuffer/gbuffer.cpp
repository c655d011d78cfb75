#include "passes/gbuffer/gbuffer.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

using engine::passes_kernels;

CameraPush camera_push(const scenes::Camera& camera, uint32_t width, uint32_t height) {
    // A scaled node scales nothing that a camera sees: only the directions of its axes count.
    const auto axis = [&](int i) { return glm::normalize(glm::dvec3(camera.to_world[i])); };
    const double tangent = std::tan(0.5 * double(camera.yfov));
    return {.position = vec3(camera.to_world[3]),
            .forward = vec3(-axis(2)),
            .right = vec3(axis(0) * (tangent * width / height)),
            .up = vec3(axis(1) * tangent)};
}

GBuffer::GBuffer(engine::Device& device, uint32_t width_, uint32_t height_, bool glossy)
    : width(width_), height(height_), positions(device, "images", "g-buffer positions", pixels()),
      normals(device, "images", "g-buffer normals", pixels()), albedo(device, "images", "g-buffer albedo", pixels()),
      gloss(device, "images", "g-buffer gloss", glossy ? pixels() : 0), emitted(device, "images", "g-buffer emitted", pixels()) {
    assert(pixels() > 0 && pixels() < uint64_t(1) << 32);
}

GBufferRef GBuffer::read(engine::Recorder& recorder) const {
    return {.positions = recorder.read(positions), .normals = recorder.read(normals), .albedo = recorder.read(albedo),
            .gloss = glossy() ? recorder.read(gloss) : Glosses{}, .width = width, .height = height};
}

GBufferPass::GBufferPass(engine::Device& device, uint32_t width, uint32_t height, const engine::Constants& variant, bool glossy, bool traces)
    : shade_(device, passes_kernels, "gbuffer/shade", variant),
      gbuffer_(device, width, height, glossy), hits_(device, "images", "primary hits", gbuffer_.pixels()),
      exhausted_(device, "images", "primary hits exhausted", 1) {
    if (traces) trace_.emplace(device, passes_kernels, "gbuffer/trace", variant);
}

void GBufferPass::record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const scenes::Camera& camera,
                         const vec3& background) {
    const CameraPush push = camera_push(camera, gbuffer_.width, gbuffer_.height);
    recorder.fill(exhausted_, 0);
    recorder.dispatch(*trace_,
                      GBufferTracePush{.bvh = bvh.read(recorder), .camera = push, .hits = recorder.write(hits_),
                                       .exhausted = recorder.write(exhausted_), .width = gbuffer_.width, .height = gbuffer_.height},
                      gbuffer_.pixels());
    record_seen(recorder, geometry, camera, background);
}

void GBufferPass::record_seen(engine::Recorder& recorder, const Geometry& geometry, const scenes::Camera& camera, const vec3& background) {
    const CameraPush push = camera_push(camera, gbuffer_.width, gbuffer_.height);
    if (!trace_) recorder.fill(exhausted_, 0);
    recorder.dispatch(shade_,
                      GBufferShadePush{.geometry = geometry.read(recorder),
                                       .hits = recorder.read(hits_),
                                       .positions = recorder.write(gbuffer_.positions),
                                       .normals = recorder.write(gbuffer_.normals),
                                       .albedo = recorder.write(gbuffer_.albedo),
                                       .gloss = gbuffer_.glossy() ? recorder.write(gbuffer_.gloss) : Glosses{},
                                       .emitted = recorder.write(gbuffer_.emitted),
                                       .eye = push.position,
                                       .forward = push.forward,
                                       .background = background,
                                       .count = uint(gbuffer_.pixels()),
                                       .has_gloss = gbuffer_.glossy()},
                      gbuffer_.pixels());
}

}  // namespace myriad::passes
