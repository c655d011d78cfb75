#include "tools/view/compare.hpp"

#include <algorithm>
#include <cmath>

#include "tools/metrics.hpp"
#include "tools/png.hpp"

namespace myriad::tools::view {
namespace {

constexpr double heat_scale = 0.5;  // relative error that is as hot as can be

bool comparable(const State& state, const std::shared_ptr<const Shown>& shown) {
    const auto& kept = state.compare.kept;
    return kept && shown && shown->complete && shown->width == kept->width && shown->height == kept->height;
}

// Once for every image that comes.
void measure_up(State& state, const std::shared_ptr<const Shown>& shown) {
    State::Compare& c = state.compare;
    if (!comparable(state, shown) || c.measured == shown) return;
    c.measured = shown;
    c.rel_mse = measure(c.kept->image, shown->image, 0).rel_mse;
    const Picture picture = heat_map(relative_errors(c.kept->image, shown->image), shown->width, shown->height, heat_scale);
    c.heat.resize(size_t(shown->width) * shown->height);
    for (size_t i = 0; i < c.heat.size(); ++i)
        c.heat[i] = 0xff000000u | uint32_t(picture.rgb[3 * i]) | uint32_t(picture.rgb[3 * i + 1]) << 8 | uint32_t(picture.rgb[3 * i + 2]) << 16;
    c.heat_texture = {shown->width, shown->height, c.heat.data()};
}

void label(const ImVec2& at, const std::string& text) {
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    draw->AddRectFilled({at.x - 5, at.y - 3}, {at.x + extent.x + 5, at.y + extent.y + 3}, IM_COL32(16, 18, 22, 200), 3);
    draw->AddText(at, IM_COL32(232, 235, 240, 255), text.c_str());
}

}  // namespace

std::vector<float> relative_errors(const Image& reference, const Image& test) {
    const Image::Rgb r = *reference.rgb(), t = *test.rgb();
    std::vector<float> out(reference.pixels());
    for (size_t i = 0; i < out.size(); ++i)
        for (const auto& [a, b] : {std::pair(r.r[i], t.r[i]), {r.g[i], t.g[i]}, {r.b[i], t.b[i]}})
            out[i] = std::max(out[i], std::abs(b - a) / std::sqrt(a * a + float(rel_mse_epsilon)));
    return out;
}

void compare_part(State& state, const std::shared_ptr<const Shown>& shown) {
    State::Compare& c = state.compare;
    if (ImGui::Button("keep this image")) state.keeps = true;
    ImGui::SameLine();
    ImGui::Checkbox("VPLs", &state.shows_lights);
    if (!c.kept) return;
    int mode = int(c.mode);
    ImGui::RadioButton("off", &mode, 0), ImGui::SameLine(), ImGui::RadioButton("wipe", &mode, 1), ImGui::SameLine(), ImGui::RadioButton("heat map", &mode, 2);
    c.mode = State::Compare::Mode(mode);
    if (mode == 1) ImGui::SetNextItemWidth(-1), ImGui::SliderFloat("##where", &c.where, 0, 1, "");
    if (comparable(state, shown)) ImGui::Text("relMSE %.3g, of %s against %s", c.rel_mse, state.technique().c_str(), c.kept_name.c_str());
    else ImGui::TextUnformatted("no two images of one size yet");
}

void show_comparison(State& state, const Area& area, const std::shared_ptr<const Shown>& shown) {
    State::Compare& c = state.compare;
    if (std::exchange(state.keeps, false)) {
        if (shown && shown->complete) c.kept = shown, c.measured.reset(), c.kept_name = state.technique(), c.mode = State::Compare::Mode::wipe;
        else say(state, "wait until the image is complete", false);
    }
    if (!c.kept || c.mode == State::Compare::Mode::off) return;
    measure_up(state, shown);
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const Area whole = fitted(area, c.kept->width, c.kept->height);
    if (c.mode == State::Compare::Mode::heat) {
        if (comparable(state, shown)) draw->AddImage(&c.heat_texture, whole.low, whole.high);
        return label({area.low.x + 14, area.low.y + 12}, "relative error, " + state.technique() + " against " + c.kept_name + ": dark none, yellow 50 % and more");
    }
    c.kept_texture = {c.kept->width, c.kept->height, c.kept->rgba.data()};
    const float edge = std::round(whole.low.x + whole.size().x * c.where);
    draw->AddImage(&c.kept_texture, whole.low, {edge, whole.high.y}, {0, 0}, {(edge - whole.low.x) / whole.size().x, 1});
    draw->AddRectFilled({edge - 1, whole.low.y}, {edge + 1, whole.high.y}, IM_COL32(255, 255, 255, 255));
    label({whole.low.x + 14, whole.low.y + 12}, c.kept_name);
    label({whole.high.x - 14 - ImGui::CalcTextSize(state.technique().c_str()).x, whole.low.y + 12}, state.technique());
}

void show_lights(const Area& area, const Shown& shown) {
    const Area whole = fitted(area, shown.width, shown.height);
    const Image::Channel* depth = shown.image.find("Z");
    const glm::mat4 to_camera = glm::inverse(shown.camera.to_world);
    const float focal = 0.5f * whole.size().y / std::tan(shown.camera.yfov / 2);
    double total = 0;
    for (const Shown::Lamp& lamp : shown.lights) total += double(glm::length(lamp.flux));
    const float mean = float(total / double(std::max<size_t>(shown.lights.size(), 1)));
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    draw->PushClipRect(whole.low, whole.high, true);
    for (const Shown::Lamp& lamp : shown.lights) {
        const glm::vec3 p(to_camera * glm::vec4(lamp.position, 1));
        if (!(p.z < 0) || mean <= 0) continue;
        const ImVec2 at{whole.low.x + whole.size().x / 2 - focal * p.x / p.z, whole.low.y + whole.size().y / 2 + focal * p.y / p.z};
        if (at.x < whole.low.x || at.x >= whole.high.x || at.y < whole.low.y || at.y >= whole.high.y) continue;
        const uint32_t x = std::min(uint32_t((at.x - whole.low.x) / whole.size().x * float(shown.width)), shown.width - 1);
        const uint32_t y = std::min(uint32_t((at.y - whole.low.y) / whole.size().y * float(shown.height)), shown.height - 1);
        const float seen = depth ? depth->values[size_t(y) * shown.width + x] : 0;
        const bool hidden = seen > 0 && -p.z > seen * 1.02f;
        const glm::vec3 hue = lamp.flux / std::max({lamp.flux.x, lamp.flux.y, lamp.flux.z, 1e-30f});
        const auto byte = [&](float c) { return int(255 * std::sqrt(std::clamp(c, 0.0f, 1.0f))); };
        const float radius = std::clamp(3.5f * std::sqrt(glm::length(lamp.flux) / mean), 1.5f, 16.0f);
        if (hidden) draw->AddCircle(at, radius, IM_COL32(byte(hue.x), byte(hue.y), byte(hue.z), 60), 10);
        else draw->AddCircleFilled(at, radius, IM_COL32(byte(hue.x), byte(hue.y), byte(hue.z), 230), 12), draw->AddCircle(at, radius, IM_COL32(0, 0, 0, 200), 12);
    }
    draw->PopClipRect();
}

}  // namespace myriad::tools::view
