// What the program says on stderr.
#pragma once

#include <string_view>

namespace myriad::tools {

// "KIND: TEXT" as one line without a full stop, whatever names and libraries put into the text: control characters, which could
// drive a terminal, become spaces. Takes no memory, for there may be none.
void say(const char* kind, std::string_view text);

}  // namespace myriad::tools
