#include "scenes/camera_path.hpp"

#include <algorithm>
#include <cmath>

#include "engine/error.hpp"
#include "scenes/import/recipe_item.hpp"
#include "scenes/moment.hpp"

namespace myriad::scenes {
namespace {

using importing::Item;
using nlohmann::json;

constexpr uint32_t width = 10;
constexpr double most_seconds = 1e6;

// Tangents that make the way through the keys smooth: at each, as fast as from the one before to the one after (Catmull and
// Rom's, for keys at any times); at the ends, as on the way to the next.
void smooth(Track& track) {
    const size_t keys = track.times.size();
    std::vector<float> out;
    out.reserve(3 * track.values.size());
    for (size_t i = 0; i < keys; ++i) {
        const size_t before = i ? i - 1 : 0, after = std::min(i + 1, keys - 1);
        std::vector<float> tangent(width, 0.0f);
        for (uint32_t c = 0; c < width && before != after; ++c)
            tangent[c] = float((double(track.values[after * width + c]) - double(track.values[before * width + c])) /
                               (double(track.times[after]) - double(track.times[before])));
        const auto value = track.values.begin() + ptrdiff_t(i * width);
        out.insert(out.end(), tangent.begin(), tangent.end());
        out.insert(out.end(), value, value + width);
        out.insert(out.end(), tangent.begin(), tangent.end());
    }
    track.values = std::move(out);
    track.interpolation = Track::Interpolation::cubic;
}

}  // namespace

CameraPath::CameraPath(const std::string& path) : file_(path), way_{.interpolation = Track::Interpolation::linear, .width = width} {
    const json document = importing::read_json(path);
    const Item root(document, path, {"camera_path", "interpolation", "yfov", "up", "keys"});
    if (root.number("camera_path", 0, 0, 1e9) != 1) root.fail("this is no camera path of version 1", "begin with \"camera_path\": 1");
    const double yfov = root.number("yfov", 45, 1, 170);
    const glm::dvec3 up = root.vector("up", {0, 1, 0});
    root.each("keys", [&](const json& value, const std::string& place) {
        const Item key(value, place, {"time", "eye", "target", "up", "yfov"});
        if (!key.has("time") || !key.has("eye") || !key.has("target")) key.fail("there is no time, no eye or no target", "give all three");
        const float time = float(key.number("time", 0, 0, most_seconds));
        if (!way_.times.empty() && !(time > way_.times.back())) key.fail("its time is not after that of the key before it", "sort the keys");
        way_.times.push_back(time);
        for (const glm::dvec3& v : {key.vector("eye", {}), key.vector("target", {}), key.vector("up", up)})
            for (int c = 0; c < 3; ++c) way_.values.push_back(float(v[c]));
        way_.values.push_back(float(key.number("yfov", yfov, 1, 170)));
    });
    if (way_.times.empty()) root.fail("there are no keys", "give at least one");
    if (root.choice("interpolation", {"smooth", "linear"}, 0) == 0) smooth(way_);
    for (const float time : way_.times) at(double(time));  // refused with the file; between keys by whoever knows the moments
}

Camera CameraPath::at(double seconds) const {
    double v[width];
    sample(way_, false, seconds, v);
    const glm::dvec3 eye(v[0], v[1], v[2]), target(v[3], v[4], v[5]), up(v[6], v[7], v[8]);
    Camera camera{.name = file_, .yfov = float(glm::radians(std::clamp(v[9], 1.0, 170.0)))};
    if (!look(camera, eye, target, up))
        throw InputError(file_ + ": at " + std::to_string(seconds) + " s the eye is at the target, or looks along \"up\"; move a key.");
    return camera;
}

}  // namespace myriad::scenes
