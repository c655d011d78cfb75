// Going on with an image that was begun.
#pragma once

#include <map>
#include <span>
#include <string>

#include "tools/reference/film.hpp"

namespace myriad::reference {

// Of all that a sample depends on beside the settings: what triangles, materials, textures, lights, surroundings and camera are.
std::string scene_digest(const scenes::Scene& scene, std::span<const scenes::Light> lights, const scenes::Triangles& triangles, const scenes::Camera& camera);

// The film of an image that was written with the settings of `about`, of the size of `film`. InputError names a setting that differs. Another
// revision of the program is no other setting: it is said in a warning.
Film resumed(const tools::Image& image, const Film& film, const std::map<std::string, std::string>& about);

}  // namespace myriad::reference
