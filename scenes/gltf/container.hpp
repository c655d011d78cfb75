// From a file on disk to a tinygltf model, with everything refused that tinygltf 2.7 does not survive.
#pragma once

#include <string>

#include <tiny_gltf.h>

namespace myriad::scenes::gltf {

// Images are not decoded yet: `image.image` holds the encoded bytes of external and data-URI images, and images in a
// buffer view are left alone (tinygltf does not check their range; see image.cpp). What tinygltf warns of goes to
// `warnings`, a line each.
tinygltf::Model read_model(const std::string& path, std::string& warnings);

}  // namespace myriad::scenes::gltf
