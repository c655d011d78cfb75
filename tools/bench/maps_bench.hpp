// What experiments share that time the maps of whole frames and judge the images made with them.
#pragma once

#include "passes/frame.hpp"
#include "scenes/moment.hpp"
#include "tools/bench/bench.hpp"
#include "tools/image.hpp"

namespace myriad::tools {

// 320 x 180 pixels, `views` VPLs, and the options' maps, samples and seed.
passes::FrameSettings frame_settings(const BenchOptions& options, uint32_t views);

// A scene at rest, with the default sky where it has no light. `source`: of the options, or `otherwise` where they name none.
struct StillScene {
    StillScene(const BenchOptions& options, const std::string& otherwise);
    StillScene(const StillScene&) = delete;
    std::string name() const;  // without folders

    std::string source;
    scenes::Scene scene;
    scenes::Triangles triangles;
    scenes::Camera camera;
};

// A scene whose lights go around it, without those that are emitting surfaces.
struct Turntable {
    std::string source;
    scenes::Scene scene;
    scenes::Triangles triangles;
    scenes::Camera camera;

    // Lights at `degrees` around the vertical through the scene's middle.
    scenes::Moment at(double degrees) const;
};
// Of the options' scene, the hairball unless they name one; says on the terminal what is measured. Throws InputError where nothing shines that could move.
Turntable load_turntable(const BenchOptions& options);

// A row with the settings that say what is in it. `source` is shortened to its file's name.
BenchRow maps_row(const char* bench, const std::string& source, const char* technique, const passes::FrameSettings& settings);

// What the frame that was rendered last took for its maps: cut and splat, or what stands in their place. A sample of the row's time and stages.
void add_maps_times(BenchRow& row, const passes::Frame& frame);

// relMSE of what white diffuse surfaces reflect, of irradiance a pixel each.
double white_error(const std::vector<vec4>& reference, const std::vector<vec4>& test, uint32_t width, uint32_t height);

// The indirect light of all pixels and channels of an image with that layer.
double indirect_light(const Image& image);

// For --images. Throws InputError where a folder is named that does not exist.
void require_folder(const std::string& images);

// The device memory's peaks since they were reset, as spec, section 5 names them.
void set_bytes(BenchRow& row, const engine::Device& device);

}  // namespace myriad::tools
