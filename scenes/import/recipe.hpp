// A recipe: a JSON file that puts a scene together from parts, with room, lights and cameras. RECIPES.md has the schema.
#pragma once

#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

// Throws InputError: "PATH: parts[2] "cup": what is wrong; cure." Keys that the schema does not know are refused.
Imported import_recipe(const std::string& path, const ImportOptions& options);

}  // namespace myriad::scenes::importing
