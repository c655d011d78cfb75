// A device, the scene that is open, and the frames that were made of it: kept, since a wish seldom needs others than the one before.
#pragma once

#include <list>
#include <optional>

#include "tools/load_scene.hpp"
#include "tools/view/worker.hpp"

namespace myriad::tools::view {

// Thrown through Frame by its progress, when something else is wished for.
struct Interrupted {};

class Worker::Studio {
public:
    using Report = std::function<void(const std::string& stage, double done)>;  // may throw Interrupted

    explicit Studio(const engine::DeviceOptions& options) : device_(options) {}

    // Loads the scene unless that is the one that is open. Returns whether it did.
    bool open(const RenderOptions& options, const Texts& texts);
    const SceneFacts& facts() const { return facts_; }

    // The image of these options, and what is known of it. `exact`: that which `render` makes; else a frame may go on from where it was.
    std::shared_ptr<Shown> render(const Texts& texts, const RenderOptions& options, bool exact, const Report& report);
    // The image that was rendered last, in the files that `options` name.
    void save(const RenderOptions& options, double exposure);

    // What the frame of these options took last time; 0: there is none.
    double last_ms(const Texts& texts);
    uint32_t validation_messages() const { return device_.validation_messages(); }

private:
    struct Made {
        std::string key;
        std::unique_ptr<passes::Frame> frame;
        std::optional<double> moment{};   // that it was moved to
        bool used = false;
        double ms = 0;
        Report report{};                  // of the render that goes on
        std::optional<engine::Cache> cache{};
    };
    std::list<Made>::iterator find(const Texts& texts);
    void make(const Texts& texts, const RenderOptions& options, const Report& report);
    scenes::Camera place(Made& made, const RenderOptions& options);

    engine::Device device_;
    std::string scene_key_;
    std::optional<LoadedScene> loaded_;
    SceneFacts facts_;
    std::list<Made> frames_;  // the one used last comes first
};

}  // namespace myriad::tools::view
