// What keys and the mouse do over the picture.
#pragma once

#include <span>

#include "engine/window.hpp"
#include "tools/view/state.hpp"

namespace myriad::tools::view {

struct Binding {
    const char *keys, *what;
};
const std::vector<Binding>& bindings();  // for the help

// Keys that went down, and ImGui's input, where no widget wants them. `seconds` since the last time.
void control(State& state, std::span<const engine::Window::Key> keys, float seconds);
// Time goes on where the scene plays.
void play(State& state, float seconds);
void step(State& state, double seconds);  // to a moment beside

}  // namespace myriad::tools::view
