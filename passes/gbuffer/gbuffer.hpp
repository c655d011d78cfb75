// What the camera sees, per pixel; see README.md.
#pragma once

#include <optional>

#include "compute/raytrace/bvh.hpp"
#include "passes/gbuffer/gbuffer_io.h"
#include "passes/geometry/geometry.hpp"

namespace myriad::passes {

// glTF's camera: yfov is the whole vertical angle; pixels are square.
CameraPush camera_push(const scenes::Camera& camera, uint32_t width, uint32_t height);

struct GBuffer {
    // `glossy`: with what the glossy lobes of surfaces need.
    GBuffer(engine::Device& device, uint32_t width, uint32_t height, bool glossy = false);
    GBufferRef read(engine::Recorder& recorder) const;
    uint64_t pixels() const { return uint64_t(width) * height; }
    bool glossy() const { return gloss.count() > 0; }

    uint32_t width, height;
    engine::Array<vec4> positions;  // see GBufferRef
    engine::Array<uvec2> normals;
    engine::Array<vec4> albedo;
    engine::Array<Gloss> gloss;     // empty unless glossy
    engine::Array<vec4> emitted;    // rgb: radiance that the surface itself sends to the camera
};

class GBufferPass {
public:
    // `variant`: specialisation constants that the scene needs of kernels, the same in all passes (Frame). `traces`: finds itself what is seen.
    GBufferPass(engine::Device& device, uint32_t width, uint32_t height, const engine::Constants& variant = {}, bool glossy = false, bool traces = true);

    // `background`: radiance that pixels see where their rays leave the scene.
    void record(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const scenes::Camera& camera,
                const vec3& background = vec3(0));

    // For one that does not trace: what is seen has been written into hits().
    void record_seen(engine::Recorder& recorder, const Geometry& geometry, const scenes::Camera& camera, const vec3& background = vec3(0));
    const engine::Array<RayHitRecord>& hits() const { return hits_; }

    const GBuffer& gbuffer() const { return gbuffer_; }
    // [0] != 0: a ray's walk met the device's limit on loops (trace.glsl), and the result cannot be trusted.
    const engine::Array<uint>& exhausted() const { return exhausted_; }

private:
    std::optional<engine::Program> trace_;
    engine::Program shade_;
    GBuffer gbuffer_;
    engine::Array<RayHitRecord> hits_;
    engine::Array<uint> exhausted_;
};

}  // namespace myriad::passes
