#include "tools/view/app.hpp"

#include <imgui.h>

#include <cmath>
#include <cstdio>

#include "engine/swapchain.hpp"
#include "tools/message.hpp"
#include "tools/output_file.hpp"
#include "tools/png.hpp"
#include "tools/view/compare.hpp"
#include "tools/view/controls.hpp"
#include "tools/view/panel.hpp"
#include "tools/view/picture.hpp"
#include "tools/view/remembered.hpp"
#include "tools/view/ui.hpp"

namespace myriad::tools::view {
namespace {

using std::chrono::duration;

double since(Clock::time_point t) { return duration<double>(Clock::now() - t).count(); }

// Makes wishes of what changes, and pictures of what comes back.
class App {
public:
    explicit App(const ViewOptions& options)
        : options_(options), state_(first_state(options)), window_("Myriad", state_.kept.width, state_.kept.height),
          device_({.select = state_.texts.contains("--device") ? state_.texts.at("--device") : "", .surfaces = window_.extensions()}), swapchain_(device_, window_), ui_(window_),
          worker_(state_.kept.divisor, engine::Window::wake) {
        log("ready");
    }

    void run() {
        while (!window_.closing() && !state_.quits) {
            const bool lively = state_.plays || since(moved_) < 0.5 || since(input_) < 0.1;
            window_.wait(lively ? 0.01 : 0.2);  // or until there is input, or something to show
            for (const std::string& file : window_.take_dropped()) open(state_, file), log("dropped " + file);
            const engine::Swapchain::Size size = swapchain_.size();
            if (size.empty()) continue;  // minimised
            follow_scene();
            ui_.begin(size.width, size.height);
            control(state_, window_.take_keys(), ImGui::GetIO().DeltaTime);
            play(state_, ImGui::GetIO().DeltaTime);
            wish();  // now, so that the worker begins while the window is drawn
            draw(size);
            // While something moves, cores are for what is rendered: the same picture once more would only make the next one late.
            const bool draws = shown_ != last_shown_ || since(moved_) > 0.15 || since(drawn_) > 0.1;
            ui_.end(draws);
            if (ImGui::IsAnyMouseDown() || ImGui::GetIO().WantTextInput) input_ = Clock::now();
            if (draws && swapchain_.show(ui_.pixels())) drawn_ = Clock::now(), note_latency();
            wish();
            save(size);
        }
        if (!options_.fresh) remember();
        if (const uint32_t messages = device_.validation_messages() + worker_.status().validation) log(std::to_string(messages) + " validation messages");
        log("closed");
    }

private:
    static State first_state(const ViewOptions& options) {
        State state;
        if (!options.fresh) state.kept = recall(config_file());
        if (options.width) state.kept.width = options.width, state.kept.height = options.height;
        state.texts = state.kept.texts;
        open(state, options.scene.empty() ? "builtin:atrium" : options.scene);
        for (const auto& [name, text] : options.texts) state.texts[name] = text;
        try {
            read(state.scene, state.texts);
        } catch (const InputError&) {  // what is remembered contradicts what is asked for
            state.texts = options.texts;
        }
        return state;
    }

    void log(const std::string& text) const {
        if (options_.verbose) tools::say("view", text);
    }

    // A scene has come: the camera begins where it says.
    void follow_scene() {
        const auto facts = worker_.facts();
        if (!facts || facts == state_.facts || facts->name != state_.scene) return;
        const bool other = !state_.facts;
        state_.facts = facts;
        state_.look.valid = false;
        const float extent = glm::length(facts->high - facts->low);
        state_.pace = std::max(extent * 0.08f, 1e-3f);
        if (!other) return;  // the same, loaded anew
        window_.set_title(facts->name + " - Myriad");
        const auto options = read(state_.scene, state_.texts);
        scenes::Camera camera = facts->first;
        if (options->eye) state_.eye = {*options->eye, *options->target, options->yfov.value_or(default_yfov)};
        else {
            for (size_t i = 0; i < facts->cameras.size(); ++i)
                if (options->camera == facts->cameras[i].name || options->camera == std::to_string(i)) camera = facts->cameras[i];
            state_.eye = eye_of(camera, 0.5f * (facts->low + facts->high));
        }
        if (options->time) state_.seconds = *options->time;
        if (!facts->warnings.empty()) say(state_, facts->warnings.front(), false);
        log("scene " + facts->name);
    }

    void draw(engine::Swapchain::Size size) {
        shown_ = worker_.shown();
        const Status status = worker_.status();
        if (shown_) picture_ = {shown_->width, shown_->height, shown_->rgba.data(), shown_->width < size.width / 2 || !shown_->complete};
        const Area area = picture_area(state_);
        show_picture(area, picture_);
        show_comparison(state_, area, shown_);
        if (state_.shows_lights && shown_) show_lights(area, *shown_);
        show_status(state_, area, status, shown_.get());
        const ImVec2 image = image_size(area);
        if (std::exchange(state_.copies, false)) copy_command(state_, image);
        show_panel(state_, status, shown_, image);
        show_message(state_, area, status);
        show_help(state_);
        if (status.error != error_) error_ = status.error, log(error_.empty() ? "well again" : "error: " + error_);
        if (state_.message != message_) message_ = state_.message, log(message_.empty() ? "message gone" : "message: " + message_);
        if (state_.compare.measured != measured_) measured_ = state_.compare.measured, log(measured_ ? "relMSE " + std::to_string(state_.compare.rel_mse) : "nothing to compare with");
        if (status.note != note_) note_ = status.note, log(note_);
        state_.kept.divisor = status.divisor ? status.divisor : state_.kept.divisor;
    }

    // The image is as large as there is room for it, once that has stopped changing, or as is asked for.
    ImVec2 image_size(const Area& area) {
        const ImVec2 room = area.size();
        if (room.x != room_.x || room.y != room_.y) room_ = room, resized_ = Clock::now();
        if (const auto found = state_.texts.find("--size"); found != state_.texts.end()) {
            const auto [width, height] = parse_size("--size", found->second);
            return {float(width), float(height)};
        }
        if (image_.x == 0 || since(resized_) > 0.2) {
            if (image_.x != std::floor(room.x) || image_.y != std::floor(room.y)) state_.changed = true;
            image_ = {std::floor(room.x), std::floor(room.y)};
        }
        return image_;
    }

    void note_latency() {
        if (!shown_ || shown_ == last_shown_) return;
        last_shown_ = shown_;
        const double late = 1000 * since(shown_->since);
        if (!shown_->complete) state_.latencies.push_back(float(late));
        if (state_.latencies.size() > 120) state_.latencies.pop_front();
        char text[160];
        std::snprintf(text, sizeof text, "%s %ux%u of wish %llu, %.0f ms, %.0f ms after input", shown_->complete ? "complete" : "preview", shown_->width, shown_->height,
                      static_cast<unsigned long long>(shown_->wish), shown_->ms, late);
        log(text);
    }

    void wish() {
        if (state_.moved) moved_ = Clock::now();
        const bool moving = since(moved_) < 0.15;
        const bool stops = was_moving_ && !moving;
        if (state_.changed || stops) {
            const ImVec2 image = image_size(picture_area(state_));
            if (image.x < 1 || image.y < 1) return;
            worker_.want({.number = ++wishes_, .scene = state_.scene, .texts = wanted_texts(), .width = uint32_t(image.x), .height = uint32_t(image.y), .moving = moving,
                          .since = Clock::now()});
            if (!moving) log("wish " + std::to_string(wishes_));
        }
        state_.changed = state_.moved = false;
        was_moving_ = moving;
    }

    Texts wanted_texts() const {
        Texts texts = state_.texts;
        texts.erase("--size");
        return texts;
    }

    void save(engine::Swapchain::Size size) {
        if (!state_.saves_png.empty() || !state_.saves_exr.empty())
            worker_.save(std::exchange(state_.saves_exr, ""), std::exchange(state_.saves_png, ""), layer_names());
        if (state_.saves_window.empty()) return;
        const std::string file = std::exchange(state_.saves_window, "");
        try {
            write_png(file, to_picture(ui_.pixels(), size.width, size.height));
            say(state_, "wrote " + file, false);
            log("wrote " + file);
        } catch (const InputError& e) {
            say(state_, e.what(), true);
        }
    }

    void remember() {
        state_.kept.texts = state_.texts;
        for (const char* name : {"--camera", "--eye", "--target", "--yfov", "--time", "--animation", "--loop", "--rebuild", "--env", "--env-lights", "--env-rotation", "--env-strength", "--size"})
            state_.kept.texts.erase(name);
        if (const auto [width, height] = window_.pixels(); width && height) state_.kept.width = int(width), state_.kept.height = int(height);
        try {
            view::remember(config_file(), state_.kept);
        } catch (const InputError& e) {
            tools::say("warning", e.what());  // what was seen was seen all the same
        }
    }

    const ViewOptions options_;
    State state_;
    engine::Window window_;
    engine::Device device_;  // the window's own: what is rendered never keeps it waiting
    engine::Swapchain swapchain_;
    Ui ui_;
    Worker worker_;
    std::shared_ptr<const Shown> shown_, last_shown_, measured_;
    Texture picture_;
    ImVec2 room_{0, 0}, image_{0, 0};
    Clock::time_point resized_, moved_, input_, drawn_;
    bool was_moving_ = false;
    uint64_t wishes_ = 0;
    std::string error_, note_, message_;  // that were logged last
};

}  // namespace

void run(const ViewOptions& options) { App(options).run(); }

}  // namespace myriad::tools::view
