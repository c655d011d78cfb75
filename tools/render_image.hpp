// The last frame as an image in linear radiance, with layers and metadata.
#pragma once

#include "tools/stats.hpp"
#include "tools/image.hpp"

namespace myriad::tools {

// Beauty R,G,B, then `layers` (some of layer_names()), read back from the device. direct is 0 in scenes without
// punctual lights.
Image read_image(engine::Device& device, const passes::Frame& frame, const std::vector<std::string>& layers);

// Error (check_failed) that counts the pixels whose beauty is NaN or infinite and names the first.
void require_finite(const Image& image);

// Scene, technique, settings, revision, device: what it takes to make the image again. No times and no paths of outputs.
std::map<std::string, std::string> image_metadata(const RunRecord& run);

}  // namespace myriad::tools
