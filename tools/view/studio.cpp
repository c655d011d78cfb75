#include "tools/view/studio.hpp"

#include <algorithm>

#include "engine/transfer.hpp"
#include "tools/exposure.hpp"
#include "tools/write_images.hpp"

namespace myriad::tools::view {
namespace {

constexpr size_t most_frames = 4;    // a preview, a step and a whole, and the whole before
constexpr uint32_t handy_views = 512;  // maps at once: a submission must end before another wish can begin

// Those of the texts that a scene, or a frame, is made of anew for.
std::string key_of(const Texts& texts, const std::vector<std::string>& names, bool without) {
    std::string key;
    for (const auto& [name, text] : texts)
        if ((std::ranges::find(names, name) == names.end()) == without) key += name + "=" + text + "\n";
    return key;
}

const std::vector<std::string> of_scene = {"--sky", "--env", "--env-lights", "--env-rotation", "--env-strength", "--animation", "--loop", "--instances", "--seed"};
const std::vector<std::string> of_moment = {"--camera", "--eye", "--target", "--yfov", "--time", "--exposure", "--device", "--cache"};

std::optional<double> moment_of(const RenderOptions& options) { return options.moves() ? std::optional(options.time.value_or(0)) : std::nullopt; }

SceneFacts facts_of(const LoadedScene& loaded, const std::string& name) {
    SceneFacts facts{.name = name, .cameras = loaded.scene.cameras, .first = scenes::pick_camera(loaded.scene, loaded.triangles, ""), .warnings = loaded.scene.warnings,
                     .low = loaded.triangles.lo, .high = loaded.triangles.hi};
    for (const scenes::Clip& clip : loaded.scene.clips) facts.clips.push_back(clip.name), facts.seconds = std::max(facts.seconds, clip.duration());
    facts.needs = {.clips = !facts.clips.empty(), .point_lights = std::ranges::count(loaded.scene.lights, scenes::Light::Type::point, &scenes::Light::type) > 0,
                   .instances = loaded.scene.instances.size() > loaded.scene.meshes.size()};
    return facts;
}

}  // namespace

bool Worker::Studio::open(const RenderOptions& options, const Texts& texts) {
    const std::optional<double> moment = moment_of(options);
    const std::string key = options.scene + "\n" + key_of(texts, of_scene, false) + (moment ? "moves" : "rests");
    if (loaded_ && key == scene_key_) {
        loaded_->look.reset();
        if (options.eye) loaded_->look = looking(options);
        loaded_->camera = scenes::find_camera(loaded_->scene, options.camera);
        return false;
    }
    std::vector<double> moments;
    if (moment) moments.push_back(*moment);
    Progress quiet(nullptr, false);
    LoadedScene loaded = load_scene(options, options.instances, moments, options.lights_of_environment(), options.frame.seed, quiet);
    frames_.clear();
    loaded_ = std::move(loaded);
    scene_key_ = key;
    facts_ = facts_of(*loaded_, options.scene);
    return true;
}

std::list<Worker::Studio::Made>::iterator Worker::Studio::find(const Texts& texts) { return std::ranges::find(frames_, key_of(texts, of_moment, true), &Made::key); }

double Worker::Studio::last_ms(const Texts& texts) {
    const auto found = find(texts);
    return found == frames_.end() ? 0 : found->ms;
}

void Worker::Studio::make(const Texts& texts, const RenderOptions& options, const Report& report) {
    while (frames_.size() >= most_frames) frames_.pop_back();
    frames_.push_front({.key = key_of(texts, of_moment, true)});
    Made& made = frames_.front();
    passes::FrameSettings settings = options.frame;
    // What views share they share within a batch, so that many small ones would take long.
    if (settings.visibility != passes::Visibility::megaviews) settings.maps.views_at_once = handy_views;
    settings.progress = [&made](const std::string& stage, double done) { made.report(stage, done); };
    if (!options.cache.empty()) settings.cache = &made.cache.emplace(options.cache);
    made.report = report;
    try {
        made.frame = std::make_unique<passes::Frame>(device_, loaded_->scene, loaded_->triangles, settings);
    } catch (...) {
        frames_.pop_front();
        throw;
    }
}

// Sets the scene as options say.
scenes::Camera Worker::Studio::place(Made& made, const RenderOptions& options) {
    const std::optional<double> moment = moment_of(options);
    if (!moment || !loaded_->triangles.motion.plays()) return loaded_->camera_at(moment, loaded_->scene.cameras);
    const scenes::Moment now = scenes::moment_at(loaded_->scene, loaded_->triangles.motion, *moment);
    if (made.moment != moment) made.frame->move_to(now), made.moment = moment;
    return loaded_->camera_at(moment, now.cameras);
}

std::shared_ptr<Shown> Worker::Studio::render(const Texts& texts, const RenderOptions& options, bool exact, const Report& report) {
    const auto found = find(texts);
    if (found != frames_.end()) {
        const bool elsewhere = loaded_->triangles.motion.plays() && found->moment != moment_of(options);
        const bool lags = options.frame.maps.update == passes::CutUpdate::lazy;
        if (exact && found->used && (elsewhere || lags)) frames_.erase(found);  // some of the images before would be in this one
        else frames_.splice(frames_.begin(), frames_, found);
    }
    if (frames_.empty() || frames_.front().key != key_of(texts, of_moment, true)) try {
            make(texts, options, report);
        } catch (const OutOfMemory&) {
            if (frames_.empty()) throw;
            frames_.clear();  // there is room without those that are kept
            make(texts, options, report);
        }
    Made& made = frames_.front();
    made.report = report;
    const scenes::Camera camera = place(made, options);
    made.used = true;
    const Clock::time_point begin = Clock::now();
    made.frame->render(camera);
    auto shown = std::make_shared<Shown>();
    shown->image = read_image(device_, *made.frame, {"Z"});
    shown->camera = camera;
    shown->exposure = options.exposure ? double(*options.exposure) : auto_exposure(*shown->image.rgb());
    shown->rgba = made.frame->tonemapped(float(shown->exposure));
    shown->done = Clock::now();
    shown->ms = made.ms = std::chrono::duration<double, std::milli>(shown->done - begin).count();
    shown->width = shown->image.width, shown->height = shown->image.height;
    shown->passes = made.frame->times(), shown->counters = made.frame->counters(), shown->size = made.frame->size();
    shown->memory = device_.memory();
    if (const passes::VplPass* vpls = exact ? made.frame->vpls() : nullptr) {
        const uint64_t count = std::min<uint64_t>(engine::download(device_, vpls->count())[0], vpls->max_vpls());
        for (const Vpl& vpl : engine::download(device_, vpls->vpls(), count))
            if (vpl.flux != glm::vec3(0)) shown->lights.push_back({vpl.position, vpl.flux});
    }
    return shown;
}

void Worker::Studio::save(const RenderOptions& options, double exposure) {
    passes::Frame& frame = *frames_.front().frame;
    RunRecord run;
    run.device = device_.info();
    run.scene = loaded_->scene.name, run.camera = loaded_->camera_name();
    run.settings = image_settings(options, frame, *loaded_, {}, moment_of(options));
    run.exposure = exposure;
    Image image = read_image(device_, frame, options.layers);
    require_finite(image);
    write_images(options, run, image, frame, {});
}

}  // namespace myriad::tools::view
