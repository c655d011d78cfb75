// An environment on the device: its picture, its lights and their views; see README.md.
#pragma once

#include <span>

#include "passes/environment/environment_io.h"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/vpl/vpl_io.h"
#include "scenes/scene.hpp"

namespace myriad::passes {

// The parallel view along the unit direction of all that lies within the bounds, for maps of this size.
View parallel_view(const vec3& direction, const vec3& lo, const vec3& hi, uint map_size);

// The scene's lights that stand for its environment.
std::span<const scenes::Light> environment_lights(const scenes::Scene& scene);

class EnvironmentPass {
public:
    // `lo`, `hi`: bounds of all that the scene ever holds; the views hold them whole.
    EnvironmentPass(engine::Device& device, const scenes::Scene& scene, const vec3& lo, const vec3& hi, uint map_size);

    // Shows the environment where the camera sees nothing: into GBuffer::emitted, after the G-buffer.
    void record_background(engine::Recorder& recorder, const GBuffer& gbuffer, const scenes::Camera& camera);

    const engine::Array<Vpl>& lights() const { return lights_; }   // far_light() each
    const engine::Array<View>& views() const { return views_; }    // parallel ones, a light each
    const engine::Array<uint>& count() const { return count_; }    // of them, on the device

private:
    uint columns_, rows_;
    float turn_;
    engine::Program background_;
    engine::Array<vec3> texels_;
    engine::Array<Vpl> lights_;
    engine::Array<View> views_;
    engine::Array<uint> count_;
};

}  // namespace myriad::passes
