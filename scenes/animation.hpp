// What a file says of movement, in the terms of glTF 2.0: a hierarchy of nodes, skins, and clips whose channels move nodes.
// What it comes to at a moment is moment.hpp's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace myriad::scenes {

inline constexpr uint32_t none = ~0u;  // "no texture", "no material", "no node" …

struct Transform {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};  // of any length but 0, which turns nothing
    glm::dvec3 scale{1};

    glm::dmat4 matrix() const;        // translation * rotation * scale
};

struct Node {
    std::string name;
    uint32_t parent = none;           // comes before it in Scene::nodes
    Transform rest;
    std::optional<glm::dmat4> matrix; // in place of `rest`: no channel moves such a node
    std::vector<float> weights;       // at rest, of the morph targets of the mesh that stands at it
};

// Joint k's matrix is world(joints[k]) * inverse_bind[k], from the space of the mesh to the world. Where the mesh stands itself
// does not matter then.
struct Skin {
    std::string name;
    std::vector<uint32_t> joints;         // nodes
    std::vector<glm::mat4> inverse_bind;  // as many; affine, finite
};

// Values over time.
struct Track {
    enum class Interpolation : uint32_t { step, linear, cubic } interpolation = Interpolation::linear;
    uint32_t width = 3;           // numbers a value: 3, 4 for rotations (x, y, z, w), the number of targets for weights
    std::vector<float> times;     // seconds, finite, each after the last; never empty
    std::vector<float> values;    // width a time; cubic: 3 * width, tangent in, value, tangent out
};

enum class Path : uint32_t { translation, rotation, scale, weights };

struct Channel {
    uint32_t node = none, track = 0;
    Path path = Path::translation;
};

struct Clip {
    std::string name;
    std::vector<Track> tracks;
    std::vector<Channel> channels;  // at most one for a node and path

    double duration() const;        // seconds from 0 to its last key; 0 where there is none after that
};

// Writes `width` values: before the first key the first value, after the last the last. `rotation`: of unit length, by the
// shorter way around where it is linear.
void sample(const Track& track, bool rotation, double seconds, double* out);

}  // namespace myriad::scenes
