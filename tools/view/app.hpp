// The viewer's loop.
#pragma once

#include <string>

#include "tools/view/wishes.hpp"

namespace myriad::tools::view {

struct ViewOptions {
    std::string scene;           // empty: the one that comes first
    Texts texts;                 // beside those that are remembered
    int width = 0, height = 0;   // of the window; 0: as remembered
    bool fresh = false;          // nothing is remembered, nor kept
    bool verbose = false;        // says on stderr what happens, a line each
};

// Until the window is closed. Throws DeviceError where none can be opened.
void run(const ViewOptions& options);

}  // namespace myriad::tools::view
