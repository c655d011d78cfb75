#include "tools/view/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/view/controls.hpp"
#include "tools/view/panel.hpp"

namespace myriad::tools::view {
namespace {

constexpr ImGuiWindowFlags bare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                  ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

}  // namespace

Area picture_area(const State& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return {{0, 0}, {std::max(size.x - panel_width(state), 1.0f), size.y}};
}

Area fitted(const Area& area, uint32_t width, uint32_t height) {
    const ImVec2 room = area.size();
    const float scale = std::min(room.x / float(width), room.y / float(height));
    const ImVec2 size{std::round(float(width) * scale), std::round(float(height) * scale)};
    const ImVec2 low{area.low.x + std::floor((room.x - size.x) / 2), area.low.y + std::floor((room.y - size.y) / 2)};
    return {low, {low.x + size.x, low.y + size.y}};
}

void show_picture(const Area& area, const Texture& picture) {
    if (!picture.texels) return;
    const Area whole = fitted(area, picture.width, picture.height);
    ImGui::GetBackgroundDrawList()->AddImage(const_cast<Texture*>(&picture), whole.low, whole.high);
}

void show_status(const State& state, const Area& area, const Status& status, const Shown* shown) {
    char text[512];
    if (!status.stage.empty()) std::snprintf(text, sizeof text, "%s  %d %%", status.stage.c_str(), int(100 * std::clamp(status.done, 0.0, 1.0)));
    else if (shown && shown->complete) std::snprintf(text, sizeof text, "complete, %.2f s", shown->ms / 1000);
    else if (shown) std::snprintf(text, sizeof text, "preview, %.0f ms", shown->ms);
    else return;
    const std::string line = state.technique() + "   " + text;
    const float pad = ImGui::GetFontSize() * 0.6f;
    const ImVec2 extent = ImGui::CalcTextSize(line.c_str()), at{area.low.x + 2 * pad, area.high.y - extent.y - 2 * pad};
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const float right = std::min(at.x + std::max(extent.x, ImGui::GetFontSize() * 18) + pad, area.high.x - pad);
    draw->AddRectFilled({at.x - pad, at.y - 0.5f * pad}, {right, at.y + extent.y + 0.5f * pad}, IM_COL32(16, 18, 22, 200), 4);
    draw->AddText(at, IM_COL32(232, 235, 240, 255), line.c_str());
    if (status.stage.empty()) return;
    const float bottom = at.y + extent.y + 0.5f * pad, left = at.x - pad;
    draw->AddRectFilled({left, bottom - 2}, {left + (right - left) * float(std::clamp(status.done, 0.0, 1.0)), bottom}, IM_COL32(230, 159, 0, 255));
}

void show_message(State& state, const Area& area, const Status& status) {
    const bool broken = state.message.empty() && !status.error.empty();
    const std::string& text = broken ? status.error : state.message.empty() ? status.note : state.message;
    if (text.empty()) return;
    const float width = std::min(area.size().x - 24, ImGui::GetFontSize() * 40);
    ImGui::SetNextWindowPos({area.low.x + area.size().x / 2, area.low.y + 14}, 0, {0.5f, 0});
    ImGui::SetNextWindowSizeConstraints({std::min(width, ImGui::GetFontSize() * 12), 0}, {width, 1e6f});
    const bool error = broken || (!state.message.empty() && state.is_error);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, error ? ImVec4(0.42f, 0.12f, 0.05f, 0.96f) : ImVec4(0.08f, 0.16f, 0.22f, 0.94f));
    ImGui::Begin("message", nullptr, bare);
    ImGui::PushTextWrapPos(width - 24);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    if (!state.message.empty() && ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) state.message.clear();
    ImGui::End();
    ImGui::PopStyleColor();
}

void show_help(State& state) {
    if (!state.shows_help) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, 0, {0.5f, 0.5f});
    ImGui::Begin("help", nullptr, bare);
    ImGui::TextUnformatted("Drop a glTF file on the window to open it. Names in the panel explain themselves.");
    ImGui::Separator();
    for (const Binding& binding : bindings()) {
        ImGui::TextColored({0.95f, 0.76f, 0.35f, 1}, "%s", binding.keys);
        ImGui::SameLine(ImGui::GetFontSize() * 8);
        ImGui::TextUnformatted(binding.what);
    }
    ImGui::End();
}

}  // namespace myriad::tools::view
