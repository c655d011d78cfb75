#include "tools/xml.hpp"

#include <cstdint>
#include <utility>

namespace myriad::tools {
namespace {

// The sequence of UTF-8 at the front and what it stands for; {1, 0} where it is none that XML 1.0 can hold.
std::pair<size_t, uint32_t> first_character(std::string_view text) {
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const uint32_t lead = byte(0);
    const size_t count = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
    if (count == 0) return {1, 0};
    uint32_t code = count == 1 ? lead : lead & (0x7fu >> count);
    for (size_t i = 1; i < count; ++i) {
        if (byte(i) >> 6 != 2) return {1, 0};
        code = code << 6 | (byte(i) & 63);
    }
    constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool legal = code >= least[count] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000) && code != 0xfffe && code != 0xffff &&
                       (code >= ' ' || code == '\t' || code == '\n' || code == '\r');
    return legal ? std::pair{count, code} : std::pair{size_t(1), 0u};
}

}  // namespace

std::string xml_escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const auto [count, code] = first_character(text);
        switch (code) {
            case 0: out += "\xef\xbf\xbd"; break;  // U+FFFD
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            case '\t': case '\n': case '\r': out += "&#" + std::to_string(code) + ";"; break;  // attributes would lose them
            default: out += text.substr(0, count);
        }
        text.remove_prefix(count);
    }
    return out;
}

}  // namespace myriad::tools
