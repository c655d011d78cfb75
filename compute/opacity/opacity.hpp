// Where triangles are, on the host: what builds the ray tree, samples the surface, and is the kernels' twin; see README.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/opacity/opacity_io.h"

namespace myriad::engine {
class Recorder;
}

namespace myriad::compute {

// Where triangles are, on the device: declares all of it as read for the next dispatch.
using OpacityReader = std::function<OpacityRef(engine::Recorder&)>;

// Looks at what kernels look at (OpacityArrays), and must not outlive it.
struct OpacityPlace {
    uint32_t triangle;      // as stored
    bool mirrored = false;  // the last two corners are swapped
};

class Opacity {
public:
    // Everywhere, whatever triangles: materials without alpha.
    Opacity() = default;
    // `texcoords…` and `colors` may be empty where no material needs them.
    Opacity(std::span<const uvec4> triangles, std::span<const vec2> texcoords, std::span<const vec2> texcoords1, std::span<const vec4> colors,
            std::span<const OpacityMaterial> materials, std::span<const uint> texels);

    // Nothing asks, whatever the triangle.
    bool everywhere() const { return everywhere_; }

    enum class Kind { everywhere, nowhere, asks };
    Kind kind(uint32_t triangle) const;  // as stored

    // At barycentrics (u, v) of a triangle, to the bit what kernels find. `id`: its number in the world.
    bool is_there(OpacityPlace at, uint32_t id, float u, float v, uint dice = opacity_alone) const;
    float alpha(OpacityPlace at, float u, float v) const;
    // What of the surface there is, on average: 0 or 1 where it is masked, else alpha.
    float mean(OpacityPlace at, float u, float v) const;

    // How much is missing for trees (opacity_io.h), and whether a sample may stand here: the question of surface sampling.
    uint missing(OpacityPlace at, float u, float v) const;
    bool is_kept(OpacityPlace at, float u, float v) const { return missing(at, u, v) < opacity_nothing; }
    bool blends() const { return blends_; }  // some material

    // All that the answers depend on beside the triangles, to tell scenes apart; nothing where nothing asks.
    std::array<std::span<const std::byte>, 5> content() const;

    // The material of something opaque.
    static OpacityMaterial opaque() { return {.alpha = 1, .cutoff = 0}; }

private:
    struct Range {
        float low, high;
    };
    uvec4 corners(OpacityPlace at) const;
    vec2 texcoord(uint32_t set, const uvec4& corners, float u, float v) const;

    std::span<const uvec4> triangles_;
    std::span<const vec2> texcoords_[2];
    std::span<const vec4> colors_;
    std::span<const OpacityMaterial> materials_;
    std::span<const uint> texels_;
    std::vector<Range> ranges_;  // of alpha without vertex colours, a material each
    bool everywhere_ = true, blends_ = false;
};

}  // namespace myriad::compute
