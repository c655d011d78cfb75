#include "tools/view/controls.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace myriad::tools::view {
namespace {

void drag(State& state) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse) return;
    constexpr float radians_a_pixel = 0.005f;
    const bool left = ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0), right = ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0);
    if ((left || right) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        if (left && state.kept.orbits) orbit(state.eye, -io.MouseDelta.x * radians_a_pixel, -io.MouseDelta.y * radians_a_pixel);
        else look(state.eye, io.MouseDelta.x * radians_a_pixel, -io.MouseDelta.y * radians_a_pixel);
        moved(state);
    }
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        const float metres = 2 * std::tan(glm::radians(state.eye.yfov) / 2) * glm::length(state.eye.target - state.eye.eye) / std::max(io.DisplaySize.y, 1.0f);
        fly(state.eye, {-io.MouseDelta.x * metres, io.MouseDelta.y * metres, 0});
        moved(state);
    }
    if (io.MouseWheel != 0) {
        if (state.kept.orbits) approach(state.eye, std::pow(0.9f, io.MouseWheel));
        else fly(state.eye, {0, 0, io.MouseWheel * state.pace * 0.2f});
        moved(state);
    }
}

void keys_that_fly(State& state, float seconds) {
    const auto axis = [](int more, int less) { return float(ImGui::IsKeyDown(more)) - float(ImGui::IsKeyDown(less)); };
    const glm::vec3 way(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
    if (way == glm::vec3(0)) return;
    const float faster = ImGui::GetIO().KeyShift ? 4.0f : 1.0f;
    fly(state.eye, way * (state.pace * faster * std::min(seconds, 0.1f)));
    moved(state);
}

void next_technique(State& state) {
    const OptionKind& option = *find_option("--visibility");
    const std::string now = state.texts.contains(option.name) ? state.texts.at(option.name) : option.fallback;
    const auto& all = option.alternatives;
    const size_t at = size_t(std::ranges::find(all, now, &Alternative::word) - all.begin());
    for (size_t i = 1; i <= all.size(); ++i) {  // the next one that what else is chosen allows
        set(state, option.name, all[(at + i) % all.size()].word);
        if (!state.is_error || state.message.empty()) return;
    }
}

}  // namespace

const std::vector<Binding>& bindings() {
    static const std::vector<Binding> all = {
        {"W A S D", "fly ahead, left, back, right"},
        {"E Q", "up, down"},
        {"Shift", "with these: four times as fast"},
        {"left drag", "look around; orbit the target, with an orbit camera"},
        {"right drag", "look around"},
        {"middle drag", "move sideways"},
        {"wheel", "ahead and back; nearer and further"},
        {"C", "fly or orbit"},
        {"R, 1 to 9", "the scene's first camera; one of its cameras"},
        {"T", "next technique"},
        {"K, X", "keep this image to compare with; wipe, heat map, off"},
        {"V", "where VPLs are, by their flux"},
        {"Space", "play or pause the animation"},
        {"[ ]", "a frame back, a frame on"},
        {"F2, F3", "save the image as PNG, as EXR with all layers"},
        {"F4", "save a picture of the window"},
        {"Ctrl+C", "copy the command line that renders this image"},
        {"Tab", "hide or show the panel"},
        {"F1, H", "this help"},
        {"Ctrl+Q", "quit"},
    };
    return all;
}

void step(State& state, double seconds) {
    if (!state.facts || !state.facts->needs.clips) return;
    state.seconds = seconds;
    state.texts["--time"] = show_number(float(seconds));
    state.changed = true;
}

void play(State& state, float seconds) {
    if (!state.plays || !state.facts) return;
    const double length = state.facts->seconds;
    double next = state.seconds + double(std::min(seconds, 0.25f));
    if (length > 0 && next >= length) next = std::fmod(next, length);
    step(state, next);
    state.moved = true;
}

void control(State& state, std::span<const engine::Window::Key> keys, float seconds) {
    ImGuiIO& io = ImGui::GetIO();
    if (state.facts) drag(state);
    if (io.WantTextInput) return;  // letters are letters
    const auto pressed = [&](int key, bool control = false) {
        return std::ranges::any_of(keys, [&](const engine::Window::Key& k) { return k.key == key && k.control == control; });
    };
    if (pressed(GLFW_KEY_Q, true)) state.quits = true;
    if (pressed(GLFW_KEY_C, true)) state.copies = true;
    if (pressed(GLFW_KEY_F1) || pressed(GLFW_KEY_H)) state.shows_help = !state.shows_help;
    if (pressed(GLFW_KEY_ESCAPE)) state.shows_help = false, state.message.clear();
    if (pressed(GLFW_KEY_TAB)) state.shows_panel = !state.shows_panel;
    if (pressed(GLFW_KEY_C)) state.kept.orbits = !state.kept.orbits;
    if (pressed(GLFW_KEY_T)) next_technique(state);
    if (pressed(GLFW_KEY_V)) state.shows_lights = !state.shows_lights;
    if (pressed(GLFW_KEY_K)) state.keeps = true;
    if (pressed(GLFW_KEY_X)) state.compare.mode = State::Compare::Mode((int(state.compare.mode) + 1) % 3);
    if (pressed(GLFW_KEY_F2)) state.saves_png = free_name(".png");
    if (pressed(GLFW_KEY_F3)) state.saves_exr = free_name(".exr");
    if (pressed(GLFW_KEY_F4)) state.saves_window = free_name(".png");
    if (!state.facts) return;
    if (!io.KeyCtrl) keys_that_fly(state, seconds);
    if (pressed(GLFW_KEY_R)) use_camera(state, "", state.facts->first);
    for (size_t i = 0; i < std::min<size_t>(9, state.facts->cameras.size()); ++i)
        if (pressed(GLFW_KEY_1 + int(i))) use_camera(state, std::to_string(i), state.facts->cameras[i]);
    constexpr double frame = 1 / RenderOptions::usual_fps;
    if (pressed(GLFW_KEY_SPACE) && state.facts->needs.clips) state.plays = !state.plays;
    if (pressed(GLFW_KEY_LEFT_BRACKET)) step(state, std::max(0.0, state.seconds - frame));
    if (pressed(GLFW_KEY_RIGHT_BRACKET)) step(state, state.seconds + frame);
}

}  // namespace myriad::tools::view
