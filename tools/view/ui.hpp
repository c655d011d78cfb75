// Dear ImGui in a window, drawn on the host.
#pragma once

#include <imgui.h>

#include <span>
#include <vector>

#include "engine/window.hpp"
#include "tools/view/raster.hpp"

namespace myriad::tools::view {

class Ui {
public:
    explicit Ui(engine::Window& window);
    ~Ui();
    Ui(const Ui&) = delete;

    // What is drawn between these is drawn into pixels() by the second, if it `draws`.
    void begin(uint32_t width, uint32_t height);
    void end(bool draws);
    std::span<const uint32_t> pixels() const { return pixels_; }

private:
    void make_font(float scale);

    const engine::Window& window_;
    float scale_ = 0;
    Texture font_;
    uint32_t width_ = 0, height_ = 0;
    std::vector<uint32_t> pixels_;
};

}  // namespace myriad::tools::view
