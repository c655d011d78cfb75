#include "tools/render_image.hpp"

#include <algorithm>
#include <cmath>

#include "compute/common/packing.h"
#include "engine/error.hpp"
#include "engine/transfer.hpp"
#include "tools/revision.hpp"

namespace myriad::tools {
namespace {

void add_colour(Image& image, const std::string& layer, const std::vector<vec4>& texels) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    const std::span<const float> floats(texels.empty() ? nullptr : &texels[0].x, texels.size() * 4);
    image.add({prefix + "R", prefix + "G", prefix + "B"}, floats, 4);
}

void add_xyz(Image& image, const std::string& layer, const std::vector<vec4>& texels) {
    image.add({layer + ".X", layer + ".Y", layer + ".Z"}, {&texels[0].x, texels.size() * 4}, 4);
}

// Where nothing is seen, depth is 0 and so are all the others.
std::vector<vec4> normals(engine::Device& device, const passes::GBuffer& gbuffer, const std::vector<vec4>& positions) {
    const std::vector<uvec2> packed = engine::download(device, gbuffer.normals);
    std::vector<vec4> out(packed.size(), vec4(0));
    for (size_t i = 0; i < out.size(); ++i)
        if (positions[i].w > 0) out[i] = vec4(unpack_direction(packed[i].x), 0);
    return out;
}

std::vector<vec4> specular(engine::Device& device, const passes::Frame& frame, size_t pixels) {
    std::vector<vec4> sum(pixels, vec4(0));
    for (const engine::Array<vec4>* light : frame.mirrored()) {
        const std::vector<vec4> half = engine::download(device, *light, pixels, pixels);
        for (size_t i = 0; i < pixels; ++i) sum[i] += half[i];
    }
    return sum;
}

}  // namespace

Image read_image(engine::Device& device, const passes::Frame& frame, const std::vector<std::string>& layers) {
    const passes::GBuffer& gbuffer = frame.gbuffer();
    Image image;
    image.width = gbuffer.width;
    image.height = gbuffer.height;
    add_colour(image, "", engine::download(device, frame.beauty()));
    for (const std::string& layer : layers) {
        if (layer == "direct") {
            add_colour(image, layer, frame.direct() ? engine::download(device, *frame.direct()) : std::vector<vec4>(image.pixels(), vec4(0)));
        } else if (layer == "indirect") {
            add_colour(image, layer, engine::download(device, frame.indirect()));
        } else if (layer == "specular") {
            add_colour(image, layer, specular(device, frame, image.pixels()));
        } else if (layer == "emission") {
            add_colour(image, layer, engine::download(device, gbuffer.emitted));
        } else if (layer == "albedo") {
            add_colour(image, layer, engine::download(device, gbuffer.albedo));
        } else {
            const std::vector<vec4> positions = engine::download(device, gbuffer.positions);
            if (layer == "N") add_xyz(image, layer, normals(device, gbuffer, positions));
            if (layer == "P") add_xyz(image, layer, positions);
            if (layer == "Z") std::ranges::transform(positions, image.add("Z").begin(), [](const vec4& p) { return p.w; });
        }
    }
    return image;
}

void require_finite(const Image& image) {
    const Image::Rgb beauty = *image.rgb();
    size_t count = 0, first = 0;
    for (size_t i = image.pixels(); i-- > 0;)
        if (!std::isfinite(beauty.r[i]) || !std::isfinite(beauty.g[i]) || !std::isfinite(beauty.b[i])) ++count, first = i;
    if (!count) return;
    throw Error(Error::Kind::check_failed,
                std::to_string(count) + " of " + std::to_string(image.pixels()) + " pixels are NaN or infinite, the first at " +
                    std::to_string(first % image.width) + "," + std::to_string(first / image.width) +
                    ", so nothing is written; look for extreme values in the scene's lights and materials, or report it");
}

std::map<std::string, std::string> image_metadata(const RunRecord& run) {
    std::map<std::string, std::string> metadata = {{"scene", run.scene},
                                                   {"camera", run.camera},
                                                   {"device", run.device.name},
                                                   {"driver", run.device.driver + " " + run.device.driver_version},
                                                   {"git_revision", git_revision}};
    for (const auto& [key, value] : run.settings.items())
        metadata[key == "visibility" ? "technique" : key] = value.is_string() ? value.get<std::string>() : value.dump();
    return metadata;
}

}  // namespace myriad::tools
