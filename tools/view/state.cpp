#include "tools/view/state.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace myriad::tools::view {
namespace {

constexpr size_t most_recent = 10;
const std::vector<std::string> of_a_scene = {"--camera", "--eye", "--target", "--yfov", "--time", "--animation", "--loop", "--rebuild", "--env", "--env-lights", "--env-rotation", "--env-strength"};

}  // namespace

void open(State& state, const std::string& scene) {
    state.scene = scene;
    for (const std::string& name : of_a_scene) state.texts.erase(name);
    auto& recent = state.kept.recent;
    std::erase(recent, scene);
    recent.insert(recent.begin(), scene);
    if (recent.size() > most_recent) recent.resize(most_recent);
    state.plays = false, state.seconds = 0, state.facts.reset();
    state.compare = {};
    state.message.clear();
    state.changed = true;
}

void set(State& state, const std::string& name, const std::string& text) {
    Texts texts = state.texts;
    if (const OptionKind* option = find_option(name); text.empty() || (option && option->fallback == text)) texts.erase(name);
    else texts[name] = text;
    try {
        read(state.scene, texts);
    } catch (const InputError& e) {
        return say(state, e.what(), true);
    }
    state.message.clear();
    state.changed |= texts != state.texts;
    state.texts = std::move(texts);
}

std::string State::technique() const {
    const OptionKind& visibility = *find_option("--visibility");
    const auto chosen = texts.find(visibility.name);
    return chosen == texts.end() ? visibility.fallback : chosen->second;
}

void say(State& state, const std::string& message, bool is_error) { state.message = message, state.is_error = is_error; }

void moved(State& state) {
    set_eye(state.texts, state.eye);
    state.changed = state.moved = true;
}

void use_camera(State& state, const std::string& name, const scenes::Camera& camera) {
    for (const char* own : {"--eye", "--target", "--yfov", "--camera"}) state.texts.erase(own);
    if (!name.empty()) state.texts["--camera"] = name;
    if (state.facts) state.eye = eye_of(camera, 0.5f * (state.facts->low + state.facts->high));
    state.changed = true;
}

std::string free_name(const std::string& ending) {
    for (int i = 1;; ++i) {
        char name[64];
        std::snprintf(name, sizeof name, "view-%04d%s", i, ending.c_str());
        if (!std::filesystem::exists(name)) return name;
    }
}

}  // namespace myriad::tools::view
