// A window of the desktop, by GLFW. Only who makes one needs a display.
#pragma once

#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace myriad::engine {

class Window {
public:
    // Throws DeviceError where there is no display. One at a time.
    Window(const std::string& title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // For DeviceOptions::surfaces.
    std::vector<std::string> extensions() const;
    GLFWwindow* handle() const { return window_; }
    void set_title(const std::string& title);

    std::pair<uint32_t, uint32_t> pixels() const;  // 0 x 0 while it is minimised
    float scale() const;                           // of its monitor: what text should be enlarged by
    bool closing() const;
    void wait(double seconds) const;  // for an event, so long at most; events are heard in here
    static void wake();               // ends wait(), from any thread
    // Keys that went down since the last call, by GLFW's names; however short they were held, none is lost.
    struct Key {
        int key;
        bool control;
    };
    std::vector<Key> take_keys() { return std::exchange(keys_, {}); }
    // Files that were dropped on it since the last call.
    std::vector<std::string> take_dropped() { return std::exchange(dropped_, {}); }

private:
    GLFWwindow* window_ = nullptr;
    std::vector<Key> keys_;
    std::vector<std::string> dropped_;
};

}  // namespace myriad::engine
