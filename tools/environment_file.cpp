#include "tools/environment_file.hpp"

#include <algorithm>
#include <fstream>

#include "engine/error.hpp"
#include "tools/exr.hpp"
#include "tools/rgbe.hpp"

namespace myriad::tools {
namespace {

constexpr float most_radiance = 1e9f;

Image read_picture(const std::filesystem::path& path) {
    require_readable(path);
    char magic[4] = {};
    std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
    if (magic[0] == '\x76' && magic[1] == '\x2f' && magic[2] == '\x31' && magic[3] == '\x01') return read_exr(path);
    if (magic[0] == '#' && magic[1] == '?') return read_rgbe(path);
    throw InputError("cannot read '" + path.string() + "': it is neither an OpenEXR nor a Radiance picture; give an .exr or .hdr file");
}

}  // namespace

scenes::Environment read_environment(const std::filesystem::path& path, float strength, double rotation, std::vector<std::string>& warnings) {
    const Image image = read_picture(path);
    const std::string cannot = "cannot use '" + path.string() + "' as an environment: ";
    const auto rgb = image.rgb();
    if (!rgb) throw InputError(cannot + "it has no channels R, G and B, nor Y; save it with colour");
    if (image.width != 2 * uint64_t(image.height))
        throw InputError(cannot + "it is " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                         ", and an equirectangular picture is twice as wide as high; convert it to one");
    scenes::Environment environment;
    environment.name = path.string();
    environment.width = image.width, environment.height = image.height;
    environment.rotation = rotation;
    environment.texels.resize(image.pixels());
    size_t repaired = 0;
    for (size_t i = 0; i < image.pixels(); ++i) {
        const glm::vec3 stored(rgb->r[i], rgb->g[i], rgb->b[i]);
        glm::vec3& texel = environment.texels[i];
        for (int c = 0; c < 3; ++c) texel[c] = stored[c] > 0 ? std::min(stored[c], most_radiance) : 0.0f;
        repaired += texel != stored;
        texel *= strength;
    }
    if (repaired)
        warnings.push_back(std::to_string(repaired) + " of " + std::to_string(image.pixels()) + " texels of '" + path.string() +
                           "' are not a number, negative or beyond 1e9, and count as 0, 0 and 1e9.");
    return environment;
}

}  // namespace myriad::tools
