// Point lights as the gather takes them, and a view each; see README.md.
#pragma once

#include "passes/geometry/lights.hpp"
#include "passes/vpl/vpl_io.h"

namespace myriad::passes {

// A view that sees all around.
View omni_view(const vec3& position);

class PointLights {
public:
    // Of LightTable::points_apart(), of which there must be some.
    PointLights(engine::Device& device, const LightTable& lights);

    // Where the table's lights have moved since: puts these where they are now. Between submissions.
    void follow(const LightTable& lights);

    const engine::Array<Vpl>& lights() const { return lights_; }   // omni_light() each
    const engine::Array<View>& views() const { return views_; }    // that see all around, a light each; nothing, where a light is dark
    const engine::Array<uint>& count() const { return count_; }    // of them, on the device

private:
    void upload(const LightTable& lights);

    engine::Device& device_;
    engine::Array<Vpl> lights_;
    engine::Array<View> views_;
    engine::Array<uint> count_;
    uint32_t moves_ = 0;  // of the table, that it has followed
};

}  // namespace myriad::passes
