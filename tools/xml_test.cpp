#include "tools/xml.hpp"

#include <gtest/gtest.h>

namespace myriad::tools {
namespace {

TEST(Xml, markup_is_text) { EXPECT_EQ(xml_escaped("a<b>&\"c\"\t'd'"), "a&lt;b&gt;&amp;&quot;c&quot;&#9;'d'"); }

TEST(Xml, what_is_a_character_stays) {
    for (const char* text : {"", "a", "\xc3\xa4", "\xe2\x82\xac", "\xef\xbf\xbd", "\xf0\x9f\x98\x80", "\xf4\x8f\xbf\xbf"}) EXPECT_EQ(xml_escaped(text), text);
}

// XML 1.0, section 2.2: neither surrogates, nor FFFE and FFFF, nor most of what is below a space; and no UTF-8 that is too long, cut off, or beyond the last.
TEST(Xml, what_is_none_is_replaced) {
    const std::string no = "\xef\xbf\xbd";
    EXPECT_EQ(xml_escaped("a\x01z"), "a" + no + "z");
    EXPECT_EQ(xml_escaped(std::string_view("\0", 1)), no);
    for (const char* text : {"\xef\xbf\xbe", "\xef\xbf\xbf", "\xed\xa0\x80", "\xe0\x80\xaf"}) EXPECT_EQ(xml_escaped(text), no + no + no);
    EXPECT_EQ(xml_escaped("\xc0\xaf"), no + no);
    EXPECT_EQ(xml_escaped("\xf4\x90\x80\x80"), no + no + no + no);
    EXPECT_EQ(xml_escaped("\xe2\x82"), no + no);
    EXPECT_EQ(xml_escaped("\xff"), no);
}

}  // namespace
}  // namespace myriad::tools
