#include "engine/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/error.hpp"

namespace myriad::engine {
namespace {

DeviceError no_window() {
    const char* why = nullptr;
    glfwGetError(&why);
    return DeviceError("no window can be opened (" + std::string(why ? why : "GLFW does not say why") +
                       "); start it on a desktop, or set DISPLAY to an X server, such as Xvfb");
}

}  // namespace

Window::Window(const std::string& title, int width, int height) {
    if (!glfwInit()) throw no_window();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const DeviceError error = no_window();
        glfwTerminate();
        throw error;
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action == GLFW_PRESS) static_cast<Window*>(glfwGetWindowUserPointer(window))->keys_.push_back({key, (modifiers & GLFW_MOD_CONTROL) != 0});
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        auto& dropped = static_cast<Window*>(glfwGetWindowUserPointer(window))->dropped_;
        dropped.insert(dropped.end(), paths, paths + count);
    });
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

std::vector<std::string> Window::extensions() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (!names) throw DeviceError("no Vulkan driver here shows pictures in windows; install one, for example Mesa's (package mesa-vulkan-drivers)");
    return {names, names + count};
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

std::pair<uint32_t, uint32_t> Window::pixels() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {uint32_t(width), uint32_t(height)};
}

float Window::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return x > 0 ? x : 1;
}

bool Window::closing() const { return glfwWindowShouldClose(window_); }
void Window::wait(double seconds) const { glfwWaitEventsTimeout(seconds); }
void Window::wake() { glfwPostEmptyEvent(); }

}  // namespace myriad::engine
