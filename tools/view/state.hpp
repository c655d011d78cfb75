// All that the window's parts look at and change.
#pragma once

#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/view/cameras.hpp"
#include "tools/view/raster.hpp"
#include "tools/view/worker.hpp"

namespace myriad::tools::view {

// What is kept from run to run (remembered.hpp).
struct Remembered {
    std::vector<std::string> recent;  // scenes, the last one first
    Texts texts;                      // of options that are about how, not what
    bool orbits = false;              // else the camera flies
    uint32_t divisor = 6;             // Pace's
    int width = 1280, height = 760;   // of the window
};

struct State {
    std::string scene;
    Texts texts;
    Remembered kept;
    bool quits = false, shows_panel = true, shows_help = false;
    bool plays = false;               // the scene's clips
    double seconds = 0;               // of the moment
    std::string message;              // for the user, until it is dismissed
    bool is_error = false;

    Eye eye;
    float pace = 0;                   // metres a second that keys fly
    std::shared_ptr<const SceneFacts> facts;  // of the scene that eye and pace are of

    bool changed = true;              // something else is wished for than last time
    bool moved = false;               // of that, something moves: what is soon is better than what is good
    std::string saves_exr, saves_png; // files to be written
    std::string saves_window;         // the same, of the window itself
    bool copies = false;              // the command line is asked for

    bool keeps = false;               // the image is to be kept, to compare with
    bool shows_lights = false;        // where VPLs are
    struct Compare {                  // with an image that is kept
        enum class Mode { off, wipe, heat } mode = Mode::off;
        std::shared_ptr<const Shown> kept, measured;
        std::string kept_name;
        float where = 0.5f;           // of the wipe
        double rel_mse = 0;           // of `measured` against `kept`
        std::vector<uint32_t> heat;
        Texture heat_texture, kept_texture;
    } compare;
    std::string technique() const;    // by its name

    struct Look {                     // of the panel at what changes seldom
        Texts texts;
        std::string scene;
        std::set<std::string> offered;
        bool valid = false;
    } look;
    Texts drafts;                     // what is being typed
    std::deque<float> latencies;      // milliseconds from input to picture, of late
};

// Another scene, from its own camera. `message` says what is wrong with it later, if anything is.
void open(State& state, const std::string& scene);
// Another value of an option; empty: its default. If that cannot be, a message says why and nothing changes.
void set(State& state, const std::string& name, const std::string& text);
void say(State& state, const std::string& message, bool is_error);
// The camera has been moved by hand.
void moved(State& state);
// Looks from one of the scene's cameras again.
void use_camera(State& state, const std::string& name, const scenes::Camera& camera);
// A file of that ending, in the working folder, that is not there yet.
std::string free_name(const std::string& ending);

}  // namespace myriad::tools::view
