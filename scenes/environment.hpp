// Natural illumination: a picture of all that surrounds a scene, and the directional lights that stand for it (ManyLoDs, Figure 7).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace myriad::scenes {

struct Scene;

// An equirectangular picture, as glTF's viewers take it: the middle of the picture lies along +x, what is right of it towards +z, and the
// upper edge is +y. Texels are even: each shines with its radiance over its solid angle.
struct Environment {
    std::string name;                  // of the file
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> texels;     // W/(m^2 sr), finite, not negative; row 0 is the upper one
    double rotation = 0;               // radians about +y: anticlockwise, seen from above
    std::vector<float> solid_angles;   // of the lights that stand for it, in the order of the scene's

    // The unit direction of a place: column and row, 0 to width and height. Within a row, equal steps are equal solid angles.
    glm::dvec3 direction(double column, double row) const;
    double solid_angle(uint32_t row) const;  // of one of its texels
    glm::dvec3 irradiance(const glm::dvec3& normal) const;  // of a surface that sees its hemisphere whole: the sum over all texels
};

// A part of an environment: all that its light stands for.
struct EnvironmentCell {
    double column0, column1, row0, row1;
    double solid_angle;
    glm::dvec3 irradiance;        // W/m^2: the sum of its texels' radiance times solid angle
    glm::dvec3 towards;           // a direction in it, by chance in proportion to luminance
};

// Splits the picture into `count` cells of equal luminance times solid angle, halving each cell's longer side until there are so many;
// each has a direction in it at random. So luminance is sampled by its density, one sample a stratum, and the sum of what the cells hold
// is the whole picture's, channel by channel. Neighbours in the order are neighbours in the
// picture, so every k-th cell is a fair sample of them. Throws InputError where all is black.
std::vector<EnvironmentCell> environment_cells(const Environment& environment, uint32_t count, uint32_t seed);

inline constexpr uint32_t default_environment_lights = 256;  // as many as a pixel gathers
inline constexpr uint32_t most_environment_lights = 16384;

// Puts the scene into the environment: `count` directional lights come after all others; 0 for who takes its light from the picture itself.
void apply_environment(Scene& scene, Environment environment, uint32_t count, uint32_t seed);

}  // namespace myriad::scenes
