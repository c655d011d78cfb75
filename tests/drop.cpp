#include "tests/drop.hpp"

namespace myriad::tools {

bool drop_file(const std::string& display, unsigned long window, const std::string& path) { return Drop(display).onto(window, path); }

}  // namespace myriad::tools
