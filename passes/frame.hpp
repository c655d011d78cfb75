// One frame, from triangles to an image. frame.cpp reads top to bottom.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compute/derived/derived.hpp"
#include "passes/compensate/compensate.hpp"
#include "passes/compose/compose.hpp"
#include "passes/deform/deform.hpp"
#include "passes/direct/direct.hpp"
#include "passes/environment/environment.hpp"
#include "passes/gathering/gathering.hpp"
#include "passes/gbuffer/gbuffer.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/glow/glow.hpp"
#include "passes/point_lights/point_lights.hpp"
#include "passes/points/points.hpp"
#include "passes/tonemap/tonemap.hpp"
#include "passes/vpl/vpl.hpp"

namespace myriad::passes {

enum class Visibility {
    manylods,  // maps from cuts through the BSH
    megaviews, // maps from both trees, that of the scene and that of the views, and shared by views
    brute,     // maps of all triangles
    ism,       // imperfect shadow maps
    rays,      // exact: the same-VPL reference
    none,      // every VPL reaches every receiver
};

// How what the camera sees is found.
enum class Primary {
    rays,    // exact
    points,  // drawn from the camera's own cut through the tree of samples
};

// How what the camera sees reflects.
enum class Brdf {
    gltf,     // as glTF's materials say: a GGX lobe over a diffuse base (passes/brdf)
    diffuse,  // the base alone: metals are black
};

// How the light of punctual point lights comes to what the camera sees.
enum class PointLighting {
    automatic,  // gathered where there are more than most_direct_points, and visibility is asked for
    direct,     // a shadow ray a pixel and light
    gather,     // as VPLs' light is: by `visibility`, `gather` and `filter`
};
// Measured (the atrium, 640 x 360, Mesa's CPU device): 75 ms a light by rays and 3.2 by its map, so rays never win in time; but what few lights show is each map's
// texels: relMSE 0.41 with 8 lights, 0.12 with 32, 0.08 with 128. 32 still take rays a few seconds.
inline constexpr uint32_t most_direct_points = 32;

// Where what the bound cuts off is given back, VPLs need not come near, and near ones are noise for a gather that picks few. README.md has what it brings; a bound
// as of 128 is better still in the atrium and in the dragon's box, and worse in Sponza, where rays then reach far (relMSE 0.022, of 0.014).
inline constexpr uint32_t compensated_vpls = 1024;

struct FrameSettings {
    uint32_t width = 640, height = 360;
    uint32_t vpls = 4096;         // the most VPLs; 0: no indirect light
    uint32_t bounces = 1;         // diffuse reflections of light before it reaches what the camera sees
    uint32_t seed = 1;
    GatherMethod gather = GatherMethod::subset;
    uint32_t subset = 256;        // VPLs that each pixel gathers, about; 0: all
    float gather_distance = std::numeric_limits<float>::infinity();  // culled: metres that VPLs' light reaches
    bool filter = true;
    Primary primary = Primary::rays;
    float primary_pixels = 1;     // points: the largest diameter of a node that is no leaf
    Brdf brdf = Brdf::gltf;
    Visibility visibility = Visibility::manylods;
    PointLighting point_lights = PointLighting::automatic;
    MapSettings maps;
    uint32_t log2_samples = 20;   // surface samples, leaves of the BSH
    uint32_t octree_levels = 0;   // megaviews: draws the scene's octree of so many levels below the root, built anew whenever something has moved; 0: the BSH
    float vpl_bound = 0;          // bound of the geometry term, 1/m^2; 0: pi * vpls / area (passes/gather), of compensated_vpls at most where it is compensated
    uint32_t compensate = 0;      // rays a pixel that give back what the bound cuts off; 0: it stays lost (passes/compensate)
    float bias = 0.5f;            // receiver bias, half diagonals of a texel
    // The sphere tree is built anew, where samples stand by then, when its extent has grown by this factor since it was built: 0: whenever
    // something has moved.
    float rebuild = std::numeric_limits<float>::infinity();
    engine::Cache* cache = nullptr;  // of what is made of the triangles before the first frame; null: it is made anew
    // Called now and then, between submissions, with a stage and how much of it is done, 0 to 1. It may throw: construction or render()
    // then ends with that, and another render() may follow.
    std::function<void(const std::string& stage, double done)> progress;
};

struct SceneSize {
    uint64_t triangles = 0;                       // in the world
    uint64_t stored_triangles = 0, instances = 0; // fewer where instances share them; instances that do
    uint64_t samples = 0, bsh_blocks = 0, bvh_nodes = 0, lights = 0;
    compute::SvoSize octree;                      // as it was built last
    bool glossy = false;                          // some surface is lit as such
};

// A step of a frame's construction, on the host's clock.
struct BuildStep {
    std::string name;
    double ms = 0;
};

struct FrameCounters {
    std::optional<uint64_t> vpls;       // alive
    std::optional<uint64_t> point_lights;  // that are gathered
    std::optional<uint64_t> prepared;   // times that light paths were prepared anew, since more VPLs lived than there is room for
    // Where the scene moves, of the sphere tree (BshQuality): its extent against what it was when built, and its overlap.
    std::optional<double> tree_growth, tree_overlap;
    std::optional<uint32_t> tree_rebuilds;  // since the first frame
    std::optional<MapCounters> maps;    // visibility by maps
    std::optional<PointsCounters> points;  // primary: points
};

class Frame {
public:
    // Uploads the scene and builds what the settings need. Throws InputError for settings out of range, OutOfMemory.
    Frame(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const FrameSettings& settings);

    // Moves everything to another moment of the scene's motion, for renders from now on: vertices, and after them trees and emitters, where
    // any move; lights. A frame begins at second 0. A scene that stands still may have its lights moved all the same.
    void move_to(const scenes::Moment& moment);
    bool moved() const { return moved_; }  // vertices have, since the last render

    // Renders into the arrays below. Throws OutOfMemory when lists cannot grow as they must.
    void render(const scenes::Camera& camera);

    // 8-bit sRGB of the last image; RGBA8 in words.
    std::vector<uint> tonemapped(float exposure);

    const GBuffer& gbuffer() const { return gbuffer_.gbuffer(); }
    const engine::Array<vec4>& beauty() const { return compose_.beauty(); }
    const engine::Array<vec4>& indirect() const { return compose_.indirect(); }
    // Of indirect light, the environment's included, what glossy lobes reflect is the sum of these arrays' second halves. Empty: nothing is
    // glossy, or there is no such light.
    std::vector<const engine::Array<vec4>*> mirrored() const {
        std::vector<const engine::Array<vec4>*> arrays;
        for (const auto* gathering : {&indirect_, &natural_})
            if (*gathering && gbuffer().glossy()) arrays.push_back(&(*gathering)->irradiance());
        return arrays;
    }
    const engine::Array<vec4>* direct() const { return lamps_ ? compose_.all_direct() : direct_ ? &direct_->radiance() : nullptr; }  // null: no punctual lights
    const VplPass* vpls() const { return vpl_ ? &*vpl_ : nullptr; }                              // null: nothing shines, or --vpls 0
    const compute::Bsh* tree() const { return tree_ ? &*tree_ : nullptr; }

    const PointLights* point_lights() const { return point_lights_ ? &*point_lights_ : nullptr; }  // null: none that are gathered
    const FrameSettings& settings() const { return settings_; }
    uint32_t block() const { return indirect_ ? indirect_->block() : 1; }  // VPL sets are block x block
    float vpl_bound() const { return vpl_bound_; }  // 1/m^2, as used
    const SceneSize& size() const { return size_; }
    const FrameCounters& counters() const { return counters_; }
    const std::vector<engine::PassTime>& times() const { return times_; }  // of the last frame
    const std::vector<BuildStep>& build_steps() const { return build_steps_; }

private:
    Frame(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& data,
          const FrameSettings& settings);
    Frame(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& data, compute::Derived derived,
          const FrameSettings& settings);
    void make_lighting(const scenes::Scene& scene, compute::Derived& derived, const scenes::Triangles& triangles);
    void make_tree(compute::Derived& derived);
    enum class Lights { vpls, far, points };
    Gathering make_gathering(uint32_t lights, Lights kind, const compute::WorldTriangles& world, const IsmScene& points);
    std::array<std::optional<Gathering>*, 3> gatherings() { return {&indirect_, &natural_, &lamps_}; }
    MapScene map_scene() const { return {.tree = tree(), .octree = octree_ ? &*octree_ : nullptr, .low = low_, .high = high_, .geometry = &geometry_}; }
    void prepare_paths();
    void see(const scenes::Camera& camera);
    void refit_tree();
    void build_octree();
    void follow_tree();
    void take_quality();
    void render_once(const scenes::Camera& camera);
    template <class Make>
    auto step(const char* name, Make make);  // reports it and times it
    void gather(Gathering& gathering, const engine::Array<Vpl>& lights, const engine::Array<View>& views, const engine::Array<uint>& count, float pixel_angle,
                const char* stage);
    void read_back_words();
    void count_maps();
    void pause(const char* stage);
    void report(const std::string& stage, double done) const;

    engine::Device& device_;
    FrameSettings settings_;
    std::vector<BuildStep> build_steps_;
    engine::Recorder recorder_;
    Geometry geometry_;
    LightTable lights_;
    compute::Bvh bvh_;
    vec3 background_{0};
    float reach_ = 0, vpl_bound_ = 0;
    vec3 low_{0}, high_{0};  // of the triangles, over all that plays
    // Passes that the scene or the settings do not need do not exist.
    std::optional<DeformPass> deform_;
    GBufferPass gbuffer_;
    std::optional<DirectPass> direct_;
    std::optional<VplPass> vpl_;
    std::optional<EnvironmentPass> environment_;
    std::optional<PointLights> point_lights_;
    std::optional<GlowPass> glow_;
    std::optional<compute::Bsh> tree_;
    std::optional<compute::Svo> octree_;
    std::optional<PointsPass> points_;
    std::optional<Gathering> indirect_, natural_, lamps_;  // of VPLs; of the environment's lights; of point lights
    std::optional<CompensatePass> compensate_;
    ComposePass compose_;
    std::optional<TonemapPass> tonemap_;
    engine::Array<uint> exhausted_, host_words_;
    bool moved_ = false;
    double tree_extent_ = 0, tree_growth_ = 1;  // when it was built, and since
    SceneSize size_;
    FrameCounters counters_;
    std::vector<engine::PassTime> times_;
};

}  // namespace myriad::passes
