// Text in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace myriad::tools {

// As text and in quoted attributes. What is no UTF-8, or no character that XML 1.0 can hold, becomes U+FFFD.
std::string xml_escaped(std::string_view text);

}  // namespace myriad::tools
