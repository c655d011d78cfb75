#include "tools/message.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace myriad::tools {

void say(const char* kind, std::string_view text) {
    while (text.ends_with('.') || text.ends_with(' ') || text.ends_with('\n')) text.remove_suffix(1);
    char line[4096];  // longer ones are cut; one write, so that the lines of two programs do not mix
    const size_t head = size_t(std::max(0, std::snprintf(line, sizeof line, "%s: ", kind)));
    const size_t count = std::min(text.size(), sizeof line - 1 - head);
    std::memcpy(line + head, text.data(), count);
    std::replace_if(line + head, line + head + count, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
    line[head + count] = '\n';
    std::fwrite(line, 1, head + count + 1, stderr);
}

}  // namespace myriad::tools
