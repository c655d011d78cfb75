#include "passes/frame.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/transfer.hpp"

namespace myriad::passes {

namespace {

double total_area(const compute::WorldTriangles& world) {
    double area = 0;
    world.for_each([&](uint32_t, uint32_t, const Corners& t) {
        const glm::dvec3 a = t.p0, b = t.p1, c = t.p2;
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    });
    return area;
}

GatherVisibility gather_visibility(Visibility v) {
    return v == Visibility::rays ? GatherVisibility::rays : v == Visibility::none ? GatherVisibility::none : GatherVisibility::maps;
}

MapMethod map_method(Visibility v, bool far) {
    switch (v) {
        case Visibility::brute: return MapMethod::brute;
        case Visibility::ism: return MapMethod::ism;
        case Visibility::megaviews: return far ? MapMethod::manylods : MapMethod::megaviews;  // parallel views have no place to be near to one another
        default: return MapMethod::manylods;
    }
}

bool gathers_points(const scenes::Scene& scene, const scenes::Triangles& triangles, const FrameSettings& settings) {
    const auto points = std::ranges::count(scene.lights, scenes::Light::Type::point, &scenes::Light::type);
    if (points == 0 || triangles.triangles.empty() || settings.point_lights == PointLighting::direct) return false;
    if (settings.point_lights == PointLighting::gather) return true;
    return points > most_direct_points && settings.visibility != Visibility::none;  // which would leave their shadows out
}

MapSettings map_settings(const FrameSettings& settings, bool far) {
    MapSettings maps = settings.maps;
    maps.method = map_method(settings.visibility, far);
    maps.seed = settings.seed;
    maps.octree = settings.octree_levels > 0;
    return maps;
}

}  // namespace

template <class Make>
auto Frame::step(const char* name, Make make) {
    struct Entry {
        std::vector<BuildStep>& steps;
        const char* name;
        std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
        ~Entry() { steps.push_back({name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count()}); }
    } entry{build_steps_, name};
    report(name, 0);
    return make();
}

Frame::Frame(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const FrameSettings& settings)
    : Frame(device, scene, triangles, geometry_data(scene, triangles), settings) {}

Frame::Frame(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& data,
             const FrameSettings& settings)
    : Frame(device, scene, triangles, data, {data.world, settings.cache}, settings) {}

Frame::Frame(engine::Device& device, const scenes::Scene& scene, const scenes::Triangles& triangles, const GeometryData& data,
             compute::Derived derived, const FrameSettings& settings)
    : device_(device), settings_(settings), recorder_(device), geometry_(step("uploading triangles", [&] { return Geometry(device, triangles, data); })),
      lights_(step("listing lights", [&] { return LightTable(device, scene, triangles, data, gathers_points(scene, triangles, settings)); })),
      bvh_(step("building the ray tree", [&] { return derived.bvh(device, compute::BvhQuality::quick, geometry_.opacity()); })),
      gbuffer_(device, settings.width, settings.height, bvh_.constants(), settings.brdf == Brdf::gltf && data.glossy, settings.primary == Primary::rays), compose_(device, settings.width, settings.height, !lights_.points_apart().empty()),
      exhausted_(device, "frame", "exhausted walks", 1), host_words_(device, "frame", "frame words", 7, engine::Location::host) {
    background_ = scene.background;
    const compute::WorldTriangles& world = derived.world();
    const glm::vec3 far = glm::max(glm::abs(triangles.lo), glm::abs(triangles.hi));
    low_ = triangles.lo, high_ = triangles.hi;
    reach_ = std::max({far.x, far.y, far.z});
    const double area = total_area(world);
    const uint32_t bounding = settings.compensate > 0 ? std::min(settings.vpls, compensated_vpls) : settings.vpls;
    vpl_bound_ = settings.vpl_bound > 0 ? settings.vpl_bound : area > 0 ? float(std::min(3.14159265 * bounding / area, 1e30)) : 1e30f;
    size_.triangles = world.count();
    size_.stored_triangles = triangles.triangles.size();
    size_.instances = std::count_if(world.instances.begin(), world.instances.end(), [](const Instance& i) { return !(i.flags & instance_in_world); });
    size_.lights = lights_.count();
    size_.glossy = gbuffer().glossy();
    size_.bvh_nodes = bvh_.nodes();

    if (DeformPass::needed(triangles)) deform_.emplace(device, triangles.motion);
    if (DirectPass::needed(lights_)) direct_.emplace(device, settings.width, settings.height, 0, bvh_.constants({{glossy_constant, size_.glossy}}));
    if (GlowPass::needed(lights_)) glow_.emplace(device, settings.width, settings.height);
    if (scene.environment) environment_.emplace(device, scene, triangles.lo, triangles.hi, settings.maps.map_size);
    if (!triangles.triangles.empty()) make_lighting(scene, derived, triangles);
    if (settings.primary == Primary::points) {
        make_tree(derived);
        points_.emplace(device, PointsSettings{.pixels = settings.primary_pixels, .append = settings.maps.append}, *tree_, geometry_, derived.world(),
                        settings.width, settings.height, bvh_.constants());
    }
    step("compiling kernels", [&] { recorder_.warm_up(); });
    if (vpl_) step("finding where light goes", [&] { prepare_paths(); });
    for (auto* gathering : gatherings())
        if (*gathering) (*gathering)->place(recorder_, map_scene());
    if (octree_) build_octree();
    if (!tree_) return;
    refit_tree();
    if (deform_ && !tree_->empty()) tree_->measure(recorder_);
}

void Frame::make_lighting(const scenes::Scene& scene, compute::Derived& derived, const scenes::Triangles& triangles) {
    const FrameSettings& settings = settings_;
    const uint32_t far_lights = uint32_t(environment_lights(scene).size());
    if (lights_.power() > 0 && settings.vpls > 0) {
        vpl_.emplace(device_, settings.vpls, bvh_.constants());
        vpl_->sure_paths(lights_, settings.bounces);  // throws when not one path fits
    }
    if (!lights_.points_apart().empty()) point_lights_.emplace(device_, lights_);
    if (!vpl_ && far_lights == 0 && !point_lights_) return;
    if (settings.octree_levels > 0) {
        assert(settings.visibility == Visibility::megaviews);
        if (far_lights > 0) throw InputError("--tree svo draws no maps of an environment's lights; give --tree bsh, or leave --env out");
        octree_.emplace(device_, derived.world(), settings.octree_levels, triangles.lo, triangles.hi);
    } else if (settings.visibility == Visibility::manylods || settings.visibility == Visibility::megaviews) {
        make_tree(derived);
    }
    compute::SurfaceSampling sampling;
    if (settings.visibility == Visibility::ism) {
        sampling = step("sampling the surface", [&] { return derived.samples(settings.log2_samples, settings.seed); });
        size_.samples = sampling.samples.size();
    }
    const vec3 extent = triangles.hi - triangles.lo;
    const IsmScene points{derived.world(), sampling, std::max({extent.x, extent.y, extent.z})};
    if (vpl_) indirect_.emplace(make_gathering(settings.vpls, Lights::vpls, derived.world(), points));
    if (vpl_ && settings.compensate > 0)
        compensate_.emplace(device_, settings.width, settings.height, settings.compensate, settings.filter, bvh_.constants({{glossy_constant, size_.glossy}}));
    if (far_lights > 0) natural_.emplace(make_gathering(far_lights, Lights::far, derived.world(), points));
    if (point_lights_) lamps_.emplace(make_gathering(uint32_t(lights_.points_apart().size()), Lights::points, derived.world(), points));
}

// Once, for who comes first.
void Frame::make_tree(compute::Derived& derived) {
    if (tree_) return;
    tree_.emplace(step("sampling the surface", [&] { return derived.bsh(device_, settings_.log2_samples, settings_.seed, settings_.maps.arity); }));
    size_.samples = tree_->leaves();
    size_.bsh_blocks = tree_->blocks();
}

Gathering Frame::make_gathering(uint32_t lights, Lights kind, const compute::WorldTriangles& world, const IsmScene& points) {
    // Far lights have no place in a tree, and a tree of lights knows hemispheres alone: others are gathered as they are when nothing else is asked for.
    const bool far = kind == Lights::far, vpls = kind == Lights::vpls;
    const bool picked = settings_.gather != GatherMethod::subset;
    const GatheringSettings settings{.visibility = gather_visibility(settings_.visibility), .width = settings_.width, .height = settings_.height,
                                     .lights = lights, .method = vpls ? settings_.gather : GatherMethod::subset,
                                     .subset = !vpls && picked ? FrameSettings{}.subset : settings_.subset, .distance = settings_.gather_distance,
                                     .seed = settings_.seed, .filter = settings_.filter, .glossy = size_.glossy, .far = far, .omni = kind == Lights::points,
                                     .bias = settings_.bias, .maps = map_settings(settings_, far)};
    return Gathering(device_, settings, bvh_.constants(), &world, &points);
}

void Frame::prepare_paths() { vpl_->prepare(recorder_, geometry_, bvh_, lights_, settings_.bounces, settings_.seed); }

void Frame::refit_tree() {
    auto scope = recorder_.scope("refit");
    tree_->refit(recorder_, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
}

void Frame::build_octree() {
    octree_->build(recorder_, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
    if (!deform_) octree_->settle();
    size_.octree = octree_->size();
}

void Frame::move_to(const scenes::Moment& moment) {
    const uint32_t before = lights_.moves();
    lights_.move(moment.lights);
    if (point_lights_) point_lights_->follow(lights_);
    if (!deform_) return;
    if (!deform_->differs(moment)) {
        if (lights_.moves() != before) lights_.follow(recorder_, geometry_);  // emitters have the areas of second 0 again
        return;
    }
    moved_ = true;
    if (tree_ && !tree_->empty() && tree_extent_ == 0) recorder_.submit_and_wait(), take_quality();  // of the tree as it was built
    {
        auto scope = recorder_.scope("deform");
        deform_->record(recorder_, geometry_, moment);
        lights_.follow(recorder_, geometry_);
    }
    {
        auto scope = recorder_.scope("refit rays");
        bvh_.refit(recorder_, geometry_.positions(), geometry_.triangles());
    }
    for (auto* gathering : gatherings())
        if (*gathering) (*gathering)->place(recorder_, map_scene());
    if (octree_) build_octree();
    if (tree_ && !tree_->empty()) follow_tree();
}

void Frame::follow_tree() {
    if (tree_growth_ > double(settings_.rebuild)) {
        auto scope = recorder_.scope("rebuild");
        tree_->rebuild(recorder_, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
        tree_extent_ = 0;
        for (auto* gathering : gatherings())
            if (*gathering) (*gathering)->forget();
    } else {
        auto scope = recorder_.scope("refit");
        tree_->refit_moving(recorder_, geometry_.positions(), geometry_.triangles(), geometry_.instances(), geometry_.opacity());
    }
    tree_->measure(recorder_);
}

// What was measured when the tree last changed; the first that is taken of a tree is what it grows from.
void Frame::take_quality() {
    const compute::BshQuality quality = tree_->quality();
    if (tree_extent_ == 0) tree_extent_ = quality.extent;
    tree_growth_ = tree_extent_ > 0 ? quality.extent / tree_extent_ : 1;
    counters_.tree_growth = tree_growth_;
    counters_.tree_overlap = quality.overlap;
    counters_.tree_rebuilds = tree_->rebuilds();
}

void Frame::report(const std::string& stage, double done) const {
    if (settings_.progress) settings_.progress(stage, done);
}

// For who is waiting: what was recorded is done, and what follows is a submission of its own.
void Frame::pause(const char* stage) {
    if (!settings_.progress) return;
    recorder_.submit_and_wait();
    report(stage, 0);
}

void Frame::render(const scenes::Camera& camera) try {
    counters_ = {};
    render_once(camera);
    // Since paths were prepared, lights or surfaces have moved so that more VPLs live than there is room for. Fewer paths, then.
    while (vpl_ && host_words_.span()[5] > 0) {
        prepare_paths();
        counters_ = {.prepared = counters_.prepared.value_or(0) + 1};  // of the image that stays
        render_once(camera);
    }
    if (deform_ && tree_ && !tree_->empty()) take_quality();
    moved_ = false;
    times_ = recorder_.take_times();
    report("done", 1);
} catch (...) {
    recorder_.take_times();  // of a frame that never was
    throw;
}

void Frame::render_once(const scenes::Camera& camera) {
    const float pixel_angle = 2 * std::tan(camera.yfov / 2) / float(settings_.height);
    see(camera);
    if (direct_) {
        pause("direct light");
        auto scope = recorder_.scope("direct");
        direct_->record(recorder_, gbuffer(), bvh_, lights_);
    }
    pause("gathering");
    if (vpl_) {
        auto scope = recorder_.scope("vpls");
        vpl_->record(recorder_, geometry_, bvh_, lights_, settings_.bounces, settings_.seed);
    }
    recorder_.fill(exhausted_, 0);
    if (indirect_) gather(*indirect_, vpl_->vpls(), vpl_->views(), vpl_->count(), pixel_angle, "gathering");
    if (natural_) gather(*natural_, environment_->lights(), environment_->views(), environment_->count(), pixel_angle, "gathering from the environment");
    if (lamps_) gather(*lamps_, point_lights_->lights(), point_lights_->views(), point_lights_->count(), pixel_angle, "gathering from point lights");
    if (compensate_) {
        auto scope = recorder_.scope("compensate");
        compensate_->record(recorder_, {gbuffer(), geometry_, bvh_, lights_, vpl_bound_, settings_.bounces, settings_.seed}, pixel_angle, exhausted_);
    }
    {
        auto scope = recorder_.scope("compose");
        compose_.record(recorder_, gbuffer(), indirect_ ? &indirect_->irradiance() : nullptr, natural_ ? &natural_->irradiance() : nullptr,
                        direct_ ? &direct_->radiance() : nullptr, lamps_ ? &lamps_->irradiance() : nullptr,
                        compensate_ ? &compensate_->irradiance() : nullptr);
    }
    read_back_words();
    if (vpl_) counters_.vpls = host_words_.span()[0];
    if (point_lights_) counters_.point_lights = lights_.points_apart().size();
    count_maps();
}

// What the camera sees, and what is behind everything.
void Frame::see(const scenes::Camera& camera) {
    while (points_) {
        points_->record(recorder_, camera_push(camera, settings_.width, settings_.height), gbuffer_.hits());
        recorder_.submit_and_wait();
        if (points_->accept()) break;
    }
    auto scope = recorder_.scope("gbuffer");
    if (points_) gbuffer_.record_seen(recorder_, geometry_, camera, background_);
    else gbuffer_.record(recorder_, geometry_, bvh_, camera, background_);
    if (environment_) environment_->record_background(recorder_, gbuffer(), camera);
    if (glow_) {
        auto glow = recorder_.scope("glow");
        glow_->record(recorder_, gbuffer(), camera, lights_);
    }
    if (points_) counters_.points = points_->take_counters();
}

void Frame::count_maps() {
    for (auto* gathering : gatherings())
        if (const auto counters = *gathering ? (*gathering)->take_counters() : std::nullopt) {
            if (!counters_.maps) counters_.maps.emplace();
            *counters_.maps += *counters;
        }
    if (settings_.visibility == Visibility::brute && counters_.maps)
        counters_.maps->triangle_views = size_.triangles * ((vpl_ ? host_words_.span()[6] : 0) + counters_.point_lights.value_or(0));
}

// The few words of a frame that the host looks at: the number of VPLs and of views, whether there was room for all, and whether every ray
// walk came to its end.
void Frame::read_back_words() {
    std::fill(host_words_.span().begin(), host_words_.span().end(), 0u);
    auto fetch = [&](const engine::Array<uint>& from, uint64_t to, uint64_t word = 0) {
        recorder_.copy(from, host_words_, sizeof(uint), word * sizeof(uint), to * sizeof(uint));
    };
    fetch(gbuffer_.exhausted(), 1);
    if (direct_) fetch(direct_->exhausted(), 2);
    if (vpl_) fetch(vpl_->count(), 0, 1), fetch(vpl_->count(), 5, 2), fetch(vpl_->count(), 6, 0), fetch(vpl_->exhausted(), 3);
    if (indirect_ || natural_ || lamps_) fetch(exhausted_, 4);
    recorder_.submit_and_wait();
    for (uint exhausted : host_words_.span().subspan(1, 4))
        if (exhausted)
            throw DeviceError("a ray's walk needs more than the " + std::to_string(device_.loop_limit()) +
                              " loop iterations that this driver allows; use Mesa 23 or later, or a scene with less overlap");
}

// The many views: their maps, batch by batch, and what their lights bring to each pixel.
void Frame::gather(Gathering& gathering, const engine::Array<Vpl>& lights, const engine::Array<View>& views, const engine::Array<uint>& count,
                   float pixel_angle, const char* stage) {
    const GatheringInputs in{.gbuffer = gbuffer(), .lights = lights, .views = views, .count = count, .bound = vpl_bound_, .scene = map_scene(),
                             .bvh = bvh_, .reach = reach_};
    gathering.record(recorder_, in, pixel_angle, exhausted_, [&](double done) { report(stage, done); });
}

std::vector<uint> Frame::tonemapped(float exposure) {
    if (!tonemap_) tonemap_.emplace(device_, uint64_t(settings_.width) * settings_.height);
    tonemap_->record(recorder_, beauty(), exposure);
    recorder_.submit_and_wait();
    recorder_.take_times();
    return engine::download(device_, tonemap_->pixels());
}

}  // namespace myriad::passes
