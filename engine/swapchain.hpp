// Pictures that the host has drawn, shown in a window.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/buffer.hpp"
#include "engine/window.hpp"

namespace myriad::engine {

class Swapchain {
public:
    // `device` was made with the window's extensions. Throws DeviceError where its queue cannot show anything there.
    Swapchain(Device& device, const Window& window);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;

    struct Size {
        uint32_t width = 0, height = 0;
        bool operator==(const Size&) const = default;
        bool empty() const { return width == 0 || height == 0; }
    };
    // Of the picture that fits now. Empty while there is nothing to be seen of the window.
    Size size();

    // Shows one of that size: RGBA8 in words, red the lowest, row 0 at the top, sRGB-encoded. False: the window has changed meanwhile and
    // nothing is shown; ask for its size again.
    bool show(std::span<const uint32_t> picture);

private:
    void make(Size size);
    void drop();

    Device& device_;
    const Window& window_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    VkPresentModeKHR mode_ = VK_PRESENT_MODE_FIFO_KHR;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    Size size_;
    bool stale_ = true;
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> drawn_;  // one an image, for it may wait long until it is shown
    VkSemaphore acquired_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;   // of the copy before
    Array<uint> staging_;
};

}  // namespace myriad::engine
