#include "tools/view/ui.hpp"

#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <filesystem>

#include "tools/message.hpp"

namespace myriad::tools::view {
namespace {

constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr uint32_t backdrop = 0xff1c1815;

void set_style(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.ChildRounding = 0;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 3;
    style.WindowPadding = {12, 10}, style.FramePadding = {7, 4}, style.ItemSpacing = {8, 6};
    style.ScrollbarSize = 12;
    style.WindowBorderSize = 0;
    ImVec4* colours = style.Colors;
    colours[ImGuiCol_WindowBg] = {0.085f, 0.095f, 0.11f, 1};
    colours[ImGuiCol_Header] = {0.15f, 0.17f, 0.20f, 1};
    colours[ImGuiCol_HeaderHovered] = {0.20f, 0.24f, 0.29f, 1};
    colours[ImGuiCol_FrameBg] = {0.16f, 0.18f, 0.21f, 1};
    colours[ImGuiCol_FrameBgHovered] = {0.22f, 0.26f, 0.32f, 1};
    colours[ImGuiCol_Button] = {0.18f, 0.24f, 0.32f, 1};
    colours[ImGuiCol_PlotHistogram] = {0.90f, 0.62f, 0.0f, 1};  // Okabe and Ito's orange
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

}  // namespace

Ui::Ui(engine::Window& window) : window_(window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // what is kept is kept elsewhere
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // lists of more than 65,536 corners, such as of thousands of discs
    ImGui_ImplGlfw_InitForOther(window.handle(), true);
}

Ui::~Ui() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Ui::make_font(float scale) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1, config.PixelSnapH = true;  // texels are pixels
    if (std::filesystem::exists(font_file)) {
        static const ImWchar letters[] = {0x20, 0x24f, 0x2010, 0x2027, 0x2190, 0x2193, 0x2264, 0x2265, 0x25b6, 0x25b6, 0};
        fonts.AddFontFromFileTTF(font_file, 15 * scale, &config, letters);
    } else {
        tools::say("note", std::string("there is no ") + font_file + " (package fonts-dejavu-core), so letters are plain");
        config.SizePixels = 13 * scale;
        fonts.AddFontDefault(&config);
    }
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    fonts.GetTexDataAsRGBA32(&texels, &width, &height);
    font_ = {uint32_t(width), uint32_t(height), reinterpret_cast<const uint32_t*>(texels)};
    fonts.SetTexID(&font_);
    set_style(scale);
    scale_ = scale;
}

void Ui::begin(uint32_t width, uint32_t height) {
    if (window_.scale() != scale_) make_font(window_.scale());  // the window has come to another monitor
    width_ = width, height_ = height;
    ImGui_ImplGlfw_NewFrame();
    ImGui::GetIO().DisplaySize = {float(width), float(height)};
    ImGui::NewFrame();
}

void Ui::end(bool draws) {
    ImGui::Render();
    if (!draws) return;
    pixels_.assign(size_t(width_) * height_, backdrop);
    draw(*ImGui::GetDrawData(), pixels_, width_, height_);
}

}  // namespace myriad::tools::view
