// A recipe: a JSON file that puts a scene together from parts, with room, lights and cameras. RECIPES.md has the schema.
#pragma once

#include "scenes/import/import.hpp"

namespace myriad::scenes::importing {

// Of all parts as they are in memory. A line of a recipe can ask for a built-in scene of gigabytes, or for a file once more; and
// a .glb ends at 4 GiB.
inline constexpr uint64_t most_recipe_bytes = 8ull << 30;

// Throws InputError: "PATH: parts[2] "cup": what is wrong; cure." Keys that the schema does not know are refused.
Scene read_recipe(const std::string& path, uint64_t most_bytes = most_recipe_bytes);

// A Reader.
Imported import_recipe(const std::string& path, const ImportOptions& options);

}  // namespace myriad::scenes::importing
