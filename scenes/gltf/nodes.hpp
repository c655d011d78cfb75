// The hierarchy of nodes: instances, cameras and lights.
#pragma once

#include <string>

#include "scenes/gltf/value.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::gltf {

inline constexpr const char* lights_extension = "KHR_lights_punctual";
// Where a scene keeps its background: three numbers in its extras, for glTF has no place for it.
inline constexpr const char* background_extra = "myriad_background";
inline constexpr const char* instancing_extension = "EXT_mesh_gpu_instancing";

// Which of the file's scenes `choice` names: by name, or by index in decimal; the file's default where it is empty. -1 for a
// file without scenes. Throws InputError naming those that exist.
int pick_scene(const Place& place, const std::string& choice);

// The file's nodes in scene.nodes.
struct Hierarchy {
    std::vector<uint32_t> of_file;  // one a node of the file: its number in scene.nodes, or none; empty where none was kept
};

// Fills scene.instances, scene.cameras and scene.lights from glTF scene `which`; -1: from every node that is nobody's child.
// Where the file has anything that moves or deforms, fills scene.nodes too, and says which thing hangs from which; an instance's
// `skin` is the file's number then.
Hierarchy read_nodes(const Place& place, int which, Scene& scene);

// Sets scene.background from glTF scene `which`, where that says one.
void read_background(const Place& place, int which, Scene& scene);

}  // namespace myriad::scenes::gltf
