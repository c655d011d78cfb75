// `myriad bench stability`: how small or large a scene may be, how far from the origin, and how much larger than it a floor that it stands on, until
// images suffer. Each scene is rendered with maps and with exact rays to the same VPLs; 160 x 90 pixels, all VPLs a pixel. `error`: `rel_mse` of
// maps against rays; `maps_moved` and `rays_moved`, of either against its own image of the scene as it is (a scaled scene is lit so that it has the same
// image; what a floor adds to it stays in). `lost` counts triangles that were refused. Each series says where one of these first exceeds twice the
// scene's own `rel_mse`. "ratio" is with the usual bound of the geometry term, "ratio_bounded" with that of the scene without the floor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/sky.hpp"
#include "tools/bench/maps_bench.hpp"
#include "tools/metrics.hpp"
#include "tools/render_image.hpp"

namespace myriad::tools {
namespace {

// x becomes scale * x + offset. Flux grows with area, so radiance stays.
void transform(scenes::Scene& scene, double scale, const glm::dvec3& offset) {
    const auto place = [&](const glm::vec3& p) { return glm::vec3(scale * glm::dvec3(p) + offset); };
    const glm::dmat4 matrix = glm::scale(glm::translate(glm::dmat4(1), offset), glm::dvec3(scale));
    for (scenes::Instance& i : scene.instances) i.to_world = glm::mat4(matrix * glm::dmat4(i.to_world));
    for (scenes::Camera& c : scene.cameras) c.to_world[3] = glm::vec4(place(glm::vec3(c.to_world[3])), 1);
    for (scenes::Light& l : scene.lights) {
        l.position = place(l.position);
        if (l.type != scenes::Light::Type::directional) l.intensity = glm::vec3(scale * scale * glm::dvec3(l.intensity));
    }
}

// A white square below everything, centred.
void add_floor(scenes::Scene& scene, const glm::dvec3& middle, double bottom, double side) {
    scenes::Material white;
    white.base_color = glm::vec4(0.7f, 0.7f, 0.7f, 1), white.metallic = 0, white.double_sided = true;
    scene.materials.push_back(white);
    scenes::Primitive p;
    for (const auto& [x, z] : {std::pair{-0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}})
        p.positions.push_back(glm::vec3(middle.x + side * x, bottom, middle.z + side * z));
    p.indices = {0, 1, 2, 0, 2, 3};
    p.material = uint32_t(scene.materials.size() - 1);
    scene.meshes.push_back({"floor", {p}});
    scene.instances.push_back({uint32_t(scene.meshes.size() - 1)});
}

struct Experiment {
    engine::Device& device;
    const BenchOptions& options;
    const RowSink& sink;
    std::string source;
    scenes::Scene scene;  // as it is
    glm::dvec3 middle{0};
    double size = 0, bottom = 0;
    float bound = 0;      // FrameSettings::vpl_bound
    uint32_t views = 0;

    struct Outcome {
        Image maps, rays;
        double error = 0;
        float bound = 0;
    };

    // One row. `as_it_is`: null, or what the images should be.
    Outcome measure_one(const char* series, double value, scenes::Scene changed, const Outcome* as_it_is) const {
        uint32_t triangles = 0;
        for (const scenes::Instance& i : changed.instances)
            for (const scenes::Primitive& p : changed.meshes[i.mesh].primitives) triangles += uint32_t(p.indices.size() / 3);
        const scenes::Triangles flat = scenes::flatten(changed, scenes::Sharing::never);
        const scenes::Camera camera = scenes::pick_camera(changed, flat, options.camera);
        passes::FrameSettings settings = frame_settings(options, views);
        settings.width = 160, settings.height = 90, settings.subset = 0, settings.vpl_bound = bound;
        BenchRow row = maps_row("stability", source, "manylods", settings);
        row.settings[series] = value;
        Outcome out;
        device.reset_memory_peaks();
        {
            passes::Frame frame(device, changed, flat, settings);
            frame.render(camera);
            add_maps_times(row, frame);
            out.maps = read_image(device, frame, {});
            row.counters["vpls"] = double(frame.counters().vpls.value_or(0));
            if (frame.counters().maps) row.counters["cut"] = double(frame.counters().maps->cut);
            out.bound = frame.vpl_bound();
            set_bytes(row, device);
        }
        settings.visibility = passes::Visibility::rays;
        passes::Frame frame(device, changed, flat, settings);
        frame.render(camera);
        out.rays = read_image(device, frame, {});
        const Metrics metrics = measure(out.rays, out.maps, 0);
        out.error = metrics.rel_mse;
        row.error["rel_mse"] = metrics.rel_mse;
        row.counters["not_finite"] = double(metrics.test.total() + metrics.reference.total());
        row.counters["lost"] = double(triangles) - double(flat.count());
        if (as_it_is) {
            row.error["maps_moved"] = measure(as_it_is->maps, out.maps, 0).rel_mse;
            row.error["rays_moved"] = measure(as_it_is->rays, out.rays, 0).rel_mse;
            out.error = std::max({out.error, row.error["maps_moved"], row.error["rays_moved"]});
        }
        std::printf("%s %-6g ", series, value);
        sink(row);
        return out;
    }

    // Values from where the scene is itself outwards.
    template <class Change>
    void series(const char* name, const std::vector<double>& values, double limit, const Outcome* as_it_is, Change change) const {
        for (const double value : values) {
            scenes::Scene changed = scene;
            change(changed, value);
            double error = std::numeric_limits<double>::infinity();
            try {
                error = measure_one(name, value, std::move(changed), as_it_is).error;
            } catch (const InputError& e) {
                std::printf("%s %g: %s\n", name, value, e.what());
            }
            if (error <= 2 * limit) continue;
            std::printf("%s: beyond twice the error of the scene as it is (%.4g) at %g\n", name, limit, value);
            limit = std::numeric_limits<double>::infinity();  // said once
        }
    }
};

std::vector<double> decades(int from, int to) {
    std::vector<double> values;
    for (int e = from; e != to + (from < to ? 1 : -1); e += from < to ? 1 : -1) values.push_back(std::pow(10.0, e));
    return values;
}

}  // namespace

void bench_stability(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const std::string source = options.scene.empty() ? "builtin:cornell" : options.scene;
    Experiment e{device, options, sink, source, scenes::load(source, options.seed)};
    scenes::apply_sky(e.scene, scenes::SkyChoice::automatic);
    if (!e.scene.skins.empty()) throw InputError("\"" + source + "\" has skins, which have no place of their own to be moved; give another --scene");
    for (scenes::Instance& i : e.scene.instances) i.node = scenes::none;
    const scenes::Triangles flat = scenes::flatten(e.scene, scenes::Sharing::never);
    if (flat.count() == 0) throw InputError("\"" + source + "\" has no surface; give another --scene");
    e.scene.cameras = {scenes::pick_camera(e.scene, flat, options.camera)};
    const glm::dvec3 lo(flat.lo), hi(flat.hi);
    e.middle = 0.5 * (lo + hi), e.size = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    transform(e.scene, 1 / e.size, -e.middle / e.size);  // its longest side is 1, around the origin
    e.bottom = 0.5 * (lo.y - hi.y) / e.size, e.middle = glm::dvec3(0);
    for (const uint32_t views : options.views.empty() ? std::vector<uint32_t>{256} : options.views) {
        e.views = views;
        std::printf("scene: %s, its longest side 1 m, %u triangles\n", source.c_str(), flat.count());
        const auto own = e.measure_one("scale", 1, e.scene, nullptr);
        const auto scale = [](scenes::Scene& s, double v) { transform(s, v, glm::dvec3(0)); };
        const auto away = [](scenes::Scene& s, double v) { transform(s, 1, v * glm::normalize(glm::dvec3(1, 0.7, -0.8))); };
        const auto floor = [&](scenes::Scene& s, double v) { add_floor(s, e.middle, e.bottom - 0.01, v); };
        e.series("scale", decades(-1, -14), own.error, &own, scale);
        e.series("scale", decades(1, 9), own.error, &own, scale);
        e.series("distance", decades(0, 7), own.error, &own, away);
        e.series("ratio", decades(0, 7), own.error, &own, floor);
        e.bound = own.bound;
        e.series("ratio_bounded", decades(0, 7), own.error, &own, floor);
        e.bound = 0;
    }
}

}  // namespace myriad::tools
