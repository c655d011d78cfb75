// A camera's way through a scene, from a JSON file; the format is described in scenes/README.md.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace myriad::scenes {

class CameraPath {
public:
    // Throws InputError: file, place, cure.
    explicit CameraPath(const std::string& path);

    // Before its first key and after its last it stands. Throws InputError where it looks nowhere.
    Camera at(double seconds) const;
    double duration() const { return double(way_.times.back()); }

private:
    std::string file_;
    Track way_;  // eye, target, up, degrees of yfov
};

}  // namespace myriad::scenes
