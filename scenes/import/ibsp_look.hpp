// What a surface of a map looks like, made up from the name of its shader: the textures themselves are in other packages.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace myriad::scenes::importing {

// What is seen through a map's sky, W/(m^2 sr).
inline constexpr glm::vec3 sky_radiance{0.30f, 0.34f, 0.42f};

// Appends a material, with a texture where it has a pattern. The same name always gives the same look:
// - words in it give the colour ("rust", "wood", "zinc" …), and its hash shifts it a little;
// - words give the pattern: courses of blocks, tiles, plates, or mottle;
// - lava shines, and so do names with "light" in them. A number at their end is the light that the map's tools made of them,
//   as in "ironcrosslt2_5000" or "pentagram_light1_3k".
void add_look(Scene& scene, const std::string& shader, uint32_t contents);

}  // namespace myriad::scenes::importing
