// Renders beside the window, on a device and a thread of its own: always the newest wish, a rung of its ladder after the other.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "passes/frame.hpp"
#include "tools/image.hpp"
#include "tools/view/ladder.hpp"

namespace myriad::tools::view {

using Clock = std::chrono::steady_clock;

struct Wish {
    uint64_t number = 0;  // 0: nothing is wished for yet
    std::string scene;
    Texts texts;
    uint32_t width = 0, height = 0;  // of the whole image
    bool moving = false;             // soon is better than good
    Clock::time_point since;         // of the input that led to it
};

// What the window must know of a scene.
struct SceneFacts {
    std::string name;
    std::vector<scenes::Camera> cameras;
    scenes::Camera first;  // that it is looked at from unless said otherwise
    std::vector<std::string> clips, warnings;
    double seconds = 0;    // that its longest clip lasts
    glm::vec3 low{0}, high{0};
    Needs needs;
};

struct Shown {
    uint64_t wish = 0;
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> rgba;
    Image image;             // the same in radiance, and Z
    scenes::Camera camera;
    struct Lamp {
        glm::vec3 position, flux;
    };
    std::vector<Lamp> lights;  // VPLs that are alive; of a complete image
    bool complete = false;   // the last rung: what `render` makes
    double exposure = 1, ms = 0;
    Clock::time_point since, done;
    std::vector<engine::PassTime> passes;
    passes::FrameCounters counters;
    std::map<std::string, engine::MemoryUse> memory;
    passes::SceneSize size;
};

struct Status {
    std::string stage;   // empty: nothing to do
    double done = 0;
    std::string error;   // of the newest wish; empty: none
    std::string note;    // of the last thing that was written
    uint32_t divisor = 0;
    uint32_t validation = 0;  // messages
};

class Worker {
public:
    // `changed` is called, from the worker's thread, when there is something new to show. `divisor`: Pace's, from an earlier run.
    Worker(uint32_t divisor, std::function<void()> changed);
    ~Worker();

    void want(Wish wish);
    // Writes the newest wish's whole image once it is there, as `render` would: what -o, --png and --aov say.
    void save(std::string exr, std::string png, std::vector<std::string> layers);

    std::shared_ptr<const Shown> shown() const;
    std::shared_ptr<const SceneFacts> facts() const;  // null: no scene is loaded yet
    Status status() const;

private:
    struct Order {
        std::string exr, png;
        std::vector<std::string> layers;
    };
    class Studio;

    void run();
    void carry_out(Studio& studio, const Wish& wish, std::optional<Order> order);
    void save(Studio& studio, const Wish& wish, const Order& order, double exposure);
    void publish(std::shared_ptr<const Shown> shown);
    void tell(const std::function<void(Status&)>& change);
    bool superseded(const Wish& wish) const;  // by another, or by the end

    const std::function<void()> changed_;
    Pace pace_;                      // what would be right
    uint32_t divisor_;               // what is used: to change it while something moves would be seen as a halt
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    Wish wish_;
    std::optional<Order> order_;
    std::shared_ptr<const Shown> shown_;
    std::shared_ptr<const SceneFacts> facts_;
    Status status_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace myriad::tools::view
