#include "tools/view/panel.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "scenes/scene.hpp"
#include "tools/view/compare.hpp"
#include "tools/view/controls.hpp"
#include "tools/view/figures.hpp"

namespace myriad::tools::view {
namespace {

std::string value_of(const State& state, const OptionKind& option) {
    const auto found = state.texts.find(option.name);
    return found == state.texts.end() ? option.fallback : found->second;
}

void tip(const std::string& help) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(help.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// Text that counts once it is entered.
void text_field(State& state, const OptionKind& option, const std::string& prefix, const std::string& now) {
    const bool typing = state.drafts.contains(option.name);
    std::string text = typing ? state.drafts[option.name] : now;
    ImGui::SetNextItemWidth(-1);
    const bool entered = ImGui::InputText("##text", &text, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemActive()) state.drafts[option.name] = text;
    if (entered || ImGui::IsItemDeactivatedAfterEdit()) set(state, option.name, text.empty() ? "" : prefix + text);
    if (!ImGui::IsItemActive()) state.drafts.erase(option.name);
}

// The alternative that a value is one of, and the number behind its colon.
std::pair<size_t, std::string> split(const OptionKind& option, const std::string& value) {
    size_t free = 0;
    for (size_t i = 0; i < option.alternatives.size(); ++i) {
        const Alternative& a = option.alternatives[i];
        if (a.kind == Alternative::Kind::free) free = i;
        else if (value == a.word) return {i, ""};
        else if (a.kind != Alternative::Kind::word && value.starts_with(a.word + ":")) return {i, value.substr(a.word.size() + 1)};
    }
    return {free, value};
}

void choose(State& state, const OptionKind& option, const std::string& value) {
    using Kind = Alternative::Kind;
    const auto [at, number] = split(option, value);
    const Alternative& now = option.alternatives[at];
    const bool numbered = now.kind == Kind::with_number || now.kind == Kind::free || (now.kind == Kind::with_or_without && !number.empty());
    ImGui::SetNextItemWidth(numbered ? ImGui::GetContentRegionAvail().x * 0.58f : -1);
    if (ImGui::BeginCombo("##choice", now.word.c_str())) {
        for (const Alternative& a : option.alternatives)
            if (ImGui::Selectable(a.word.c_str(), a == now)) {
                const std::string digits = number.find_first_not_of("0123456789") == std::string::npos && !number.empty() ? number : "16";
                set(state, option.name, a.kind == Kind::with_number ? a.word + ":" + digits : a.kind == Kind::free ? "1" : a.word);
            }
        ImGui::EndCombo();
    }
    if (!numbered) return;
    ImGui::SameLine();
    text_field(state, option, now.kind == Kind::free ? "" : now.word + ":", number);
}

void widget(State& state, const OptionKind& option) {
    ImGui::PushID(option.name.c_str());
    const std::string value = value_of(state, option);
    const bool chosen = state.texts.contains(option.name);
    ImGui::AlignTextToFramePadding();
    if (chosen) ImGui::TextColored({0.95f, 0.76f, 0.35f, 1}, "%s", option.name.c_str() + 2);
    else ImGui::TextUnformatted(option.name.c_str() + 2);
    tip(option.help + (option.fallback.empty() ? "" : "\n(" + option.fallback + " unless chosen; a click on the name resets it)"));
    if (ImGui::IsItemClicked() && chosen) set(state, option.name, "");
    ImGui::SameLine(ImGui::GetFontSize() * 7.6f);
    if (option.flag()) {
        bool on = value == "on";
        if (ImGui::Checkbox("##on", &on)) set(state, option.name, on ? "on" : "off");
    } else if (option.alternatives.size() > 1) {
        choose(state, option, value);
    } else {
        text_field(state, option, "", value);
    }
    ImGui::PopID();
}

void scene_part(State& state) {
    ImGui::PushID("scene");
    std::string& typed = state.drafts["scene"];
    if (!ImGui::IsPopupOpen("recent") && ImGui::GetActiveID() != ImGui::GetID("##scene")) typed = state.scene;
    ImGui::SetNextItemWidth(-ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::InputText("##scene", &typed, ImGuiInputTextFlags_EnterReturnsTrue) && !typed.empty()) open(state, typed);
    tip("a .gltf or .glb file, or builtin:NAME; Enter opens it. A file dropped on the window opens as well");
    ImGui::SameLine();
    if (ImGui::ArrowButton("##recent", ImGuiDir_Down)) ImGui::OpenPopup("recent");
    if (ImGui::BeginPopup("recent")) {
        std::vector<std::string> scenes = state.kept.recent;
        for (const std::string& line : scenes::builtin_names()) {
            const std::string name = "builtin:" + line.substr(0, line.find_first_of(" ?"));
            if (std::ranges::find(scenes, name) == scenes.end()) scenes.push_back(name);
        }
        for (const std::string& scene : scenes)
            if (ImGui::MenuItem(scene.c_str(), nullptr, scene == state.scene)) open(state, scene);
        ImGui::EndPopup();
    }
    ImGui::PopID();
}

void camera_part(State& state) {
    const SceneFacts& facts = *state.facts;
    int mode = state.kept.orbits;
    ImGui::RadioButton("fly", &mode, 0), ImGui::SameLine(), ImGui::RadioButton("orbit", &mode, 1);
    state.kept.orbits = mode == 1;
    const bool own = state.texts.contains("--eye");
    const std::string now = own ? "by hand" : state.texts.contains("--camera") ? state.texts.at("--camera") : "first";
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##camera", now.c_str())) {
        if (ImGui::Selectable("first", now == "first")) use_camera(state, "", facts.first);
        for (size_t i = 0; i < facts.cameras.size(); ++i) {
            const std::string index = std::to_string(i), name = facts.cameras[i].name.empty() ? index : index + ": " + facts.cameras[i].name;
            if (ImGui::Selectable(name.c_str(), now == index)) use_camera(state, index, facts.cameras[i]);
        }
        ImGui::EndCombo();
    }
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("field of view").x - 10);
    if (ImGui::SliderFloat("field of view", &state.eye.yfov, 5, 120, "%.0f°")) moved(state);
}

void time_part(State& state) {
    if (ImGui::Button(state.plays ? "pause" : "play")) state.plays = !state.plays;
    ImGui::SameLine();
    constexpr double frame = 1 / RenderOptions::usual_fps;
    if (ImGui::Button("<")) step(state, std::max(0.0, state.seconds - frame));
    ImGui::SameLine();
    if (ImGui::Button(">")) step(state, state.seconds + frame);
    ImGui::SameLine();
    float seconds = float(state.seconds);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##time", &seconds, 0, float(std::max(state.facts->seconds, 0.01)), "%.2f s")) step(state, double(seconds)), state.moved = true;
}

// Many trials, so not for every step of the camera: where it is decides nothing.
void refresh(State& state) {
    State::Look& look = state.look;
    Texts texts = state.texts;
    for (const char* where : {"--camera", "--eye", "--target", "--yfov"}) texts.erase(where);
    if (texts.contains("--time")) texts["--time"] = "0";
    if (look.valid && look.texts == texts && look.scene == state.scene) return;
    look = {.texts = std::move(texts), .scene = state.scene, .valid = state.facts != nullptr};
    for (const Group& group : groups())
        for (const std::string& name : group.options)
            if (offered(*find_option(name), state.scene, state.texts, state.facts ? state.facts->needs : Needs{})) look.offered.insert(name);
}

void outputs_part(State& state, const ImVec2& image) {
    if (ImGui::Button("PNG")) state.saves_png = free_name(".png");
    tip("the whole image, as --png writes it, into the working folder");
    ImGui::SameLine();
    if (ImGui::Button("EXR with layers")) state.saves_exr = free_name(".exr");
    ImGui::SameLine();
    if (ImGui::Button("copy command")) copy_command(state, image);
    tip("the myriad render command line that makes this image");
}

}  // namespace

float panel_width(const State& state) { return state.shows_panel ? ImGui::GetFontSize() * 22 : 0; }

void copy_command(State& state, const ImVec2& image) {
    std::vector<std::string> arguments = render_arguments(state.scene, state.texts, uint32_t(image.x), uint32_t(image.y));
    arguments.insert(arguments.end(), {"--png", "view.png"});
    const std::string line = shell_line(arguments);
    ImGui::SetClipboardText(line.c_str());
    say(state, "copied: " + line, false);
}

void show_panel(State& state, const Status& status, const std::shared_ptr<const Shown>& shown, const ImVec2& image) {
    const float width = panel_width(state);
    if (width == 0) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - width, 0});
    ImGui::SetNextWindowSize({width, size.y});
    ImGui::Begin("panel", nullptr, (ImGuiWindowFlags_NoDecoration & ~ImGuiWindowFlags_NoScrollbar) | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    scene_part(state);
    outputs_part(state, image);
    if (state.facts) {
        ImGui::Separator();
        camera_part(state);
        if (state.facts->needs.clips) time_part(state);
    }
    refresh(state);
    for (const Group& group : groups()) {
        if (std::ranges::none_of(group.options, [&](const std::string& name) { return state.look.offered.contains(name); })) continue;
        if (!ImGui::CollapsingHeader(group.title, group.options.front() == "--visibility" ? ImGuiTreeNodeFlags_DefaultOpen : 0)) continue;
        for (const std::string& name : group.options)
            if (state.look.offered.contains(name)) widget(state, *find_option(name));
    }
    if (ImGui::CollapsingHeader("Compare", ImGuiTreeNodeFlags_DefaultOpen)) compare_part(state, shown);
    if (shown && ImGui::CollapsingHeader("What it took", ImGuiTreeNodeFlags_DefaultOpen)) show_figures(state, *shown, status);
    ImGui::End();
}

}  // namespace myriad::tools::view
