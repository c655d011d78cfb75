// glTF 2.0, .gltf and .glb.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace myriad::scenes {

// `choice` is the name or index of one of the file's scenes, empty for its default. Throws InputError (file, place, cure)
// for whatever is wrong with the file; what is merely unsupported and harmless becomes one of the scene's warnings.
Scene load_gltf(const std::string& path, const std::string& choice = "");

// "file.glb#scene" as file and choice; a file whose own name has a # is taken as it is, with no choice.
struct FileAndChoice {
    std::string path, choice;
};
FileAndChoice split_choice(const std::string& source);

}  // namespace myriad::scenes
