#include "tools/view/figures.hpp"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "tools/stats.hpp"

namespace myriad::tools::view {
namespace {

// A bar for each: its part of the whole, its number beside.
void bars(const std::vector<std::pair<std::string, double>>& rows, const char* format) {
    double most = 0;
    for (const auto& [name, value] : rows) most = std::max(most, value);
    for (const auto& [name, value] : rows) {
        char text[48];
        std::snprintf(text, sizeof text, format, value);
        ImGui::TextUnformatted(name.c_str());
        ImGui::SameLine(ImGui::GetFontSize() * 7.6f);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFontSize();
        const float part = most > 0 ? float(value / most) : 0;
        ImDrawList* draw = ImGui::GetWindowDrawList();
        const float top = at.y;
        draw->AddRectFilled({at.x, top}, {at.x + width, top + height}, IM_COL32(38, 44, 52, 255));
        draw->AddRectFilled({at.x, top}, {at.x + width * part, top + height}, IM_COL32(0, 114, 178, 255));  // Okabe and Ito's blue
        draw->AddText({at.x + 6, top}, IM_COL32(235, 238, 242, 255), text);
        ImGui::Dummy({width, height});
    }
}

void count(const char* name, uint64_t value) {
    std::string digits = std::to_string(value);
    for (int at = int(digits.size()) - 3; at > 0; at -= 3) digits.insert(size_t(at), " ");
    ImGui::TextUnformatted(name);
    ImGui::SameLine(ImGui::GetFontSize() * 12);
    ImGui::TextUnformatted(digits.c_str());
}

}  // namespace

void show_figures(const State& state, const Shown& shown, const Status& status) {
    ImGui::Text("%u x %u in %.0f ms%s", shown.width, shown.height, shown.ms, shown.complete ? "" : ", a preview");
    std::vector<std::pair<std::string, double>> rows;
    for (const PassSum& sum : sum_passes(shown.passes)) rows.emplace_back(sum.name, sum.gpu_ms > 0 ? sum.gpu_ms : sum.cpu_ms);
    bars(rows, "%.1f ms");
    if (!state.latencies.empty()) {
        const std::vector<float> late(state.latencies.begin(), state.latencies.end());
        char text[64];
        std::snprintf(text, sizeof text, "input to picture: %.0f ms", double(late.back()));
        ImGui::PlotLines("##latency", late.data(), int(late.size()), 0, text, 0, 200, {-1, ImGui::GetFontSize() * 3});
    }
    count("triangles", shown.size.triangles);
    if (shown.counters.vpls) count("VPLs alive", *shown.counters.vpls);
    if (const auto& maps = shown.counters.maps) {
        if (maps->node_views) count("node-views tested", maps->node_views);
        if (maps->cut) count("in the cuts", maps->cut);
        if (maps->list_capacity) count("longest list", maps->list_peak), count("room in it", maps->list_capacity);
        count("batches", maps->batches);
        if (maps->pairs) {
            ImGui::TextUnformatted("pairs, by fate");
            const double culled = double(maps->pairs_culled), edge_on = double(maps->pairs_edge_on), rendered = double(maps->pairs_rendered);
            bars({{"culled", culled / 1e3}, {"edge-on", edge_on / 1e3}, {"rendered", rendered / 1e3}, {"opened", (double(maps->pairs) - culled - edge_on - rendered) / 1e3}}, "%.0f thousand");
        }
    }
    ImGui::TextUnformatted("memory on the device, by kind");
    rows.clear();
    for (const auto& [kind, use] : shown.memory)
        if (use.now >> 10) rows.emplace_back(kind, double(use.now) / (1 << 20));
    bars(rows, "%.1f MiB");
    if (status.validation) ImGui::TextColored({0.95f, 0.4f, 0.3f, 1}, "%u validation messages", status.validation);
}

}  // namespace myriad::tools::view
