// Other people's files as scenes: for `myriad convert`, which makes .glb of them. Rendering reads glTF only.
//
// A new format is a file with a reader, and a row in formats() (import.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace myriad::scenes {

enum class Axis { x, y, z };

// How strands of hair become triangles.
struct StrandOptions {
    // 2: ribbons, which turn their flat side away from the middle of the strands' roots; 3 and more: tubes with so many sides.
    uint32_t sides = 4;
    uint32_t keep_every = 1;  // a strand in so many is kept, so many times as thick
};

// How to read a file. What is not given follows from the file, or from what its format usually means.
struct ImportOptions {
    std::optional<double> unit;    // metres a unit of the file
    std::optional<Axis> up;        // the axis of the file that points up
    std::optional<float> crease;   // degrees: where normals are missing, edges that turn less are smoothed; 0: none are
    bool linear_colors = false;    // colours of materials and vertices are linear, not sRGB as seen on a screen
    StrandOptions strands;
};

// What a reader hands over: the scene in the file's own units and axes. import_scene() turns and scales it, computes
// missing normals and repairs harmless defects, so that a reader does none of that.
struct Imported {
    Scene scene;
    double unit = 1;       // metres a unit, where the options do not say
    Axis up = Axis::y;     // likewise
    float crease = 40;     // likewise
};

// Throws InputError: "PATH: what is wrong; cure." `path` is a file that exists.
using Reader = Imported (*)(const std::string& path, const ImportOptions& options);

struct Format {
    std::vector<std::string> endings;  // of the file's name, lower case: ".obj", ".ply.gz"; case does not count
    std::string name;                  // for -h, with what is particular: "Wavefront OBJ with its MTL"
    Reader read;
};

const std::vector<Format>& formats();

// Any file that formats() knows by its ending, PATH#NAME or PATH#INDEX for another scene of a glTF file than its default, or "builtin:NAME[?key=value&…]". In metres, +Y up, ready to be written.
Scene import_scene(const std::string& source, const ImportOptions& options = {}, uint32_t seed = 1);

}  // namespace myriad::scenes
