#include "marey/files/text_safety.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

const std::string kGone = "\xEF\xBF\xBD";

TEST(TextSafety, KeepsValidText) {
  for (const char* text : {"", "left knee", "Müller", "渡辺", "😀", "a\xC2\xA0z"}) EXPECT_EQ(plain_text(text), text);
}

TEST(TextSafety, ForeignBytesAndControlCharactersAreSeen) {
  EXPECT_EQ(plain_text("M\xFCller"), "M" + kGone + "ller");
  EXPECT_EQ(plain_text("a\x01z\x1B[31m\x7F"), "a" + kGone + "z" + kGone + "[31m" + kGone);
  EXPECT_EQ(plain_text(std::string_view("a\0z", 3)), "a" + kGone + "z");
  EXPECT_EQ(plain_text("a\tb\nc\r"), "a b c ");
  EXPECT_EQ(plain_text("\xC3"), kGone) << "cut off";
  EXPECT_EQ(plain_text("\xC0\xAF"), kGone + kGone) << "an overlong form";
  EXPECT_EQ(plain_text("\xED\xA0\x80"), kGone + kGone + kGone) << "a surrogate";
  EXPECT_EQ(plain_text("\xF4\x90\x80\x80").find('\xF4'), std::string::npos) << "beyond Unicode";
  EXPECT_EQ(plain_text("\xEF\xBF\xBF"), kGone) << "no character, and none in XML";
}

TEST(TextSafety, PlainTextIsPlainAlready) {
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  EXPECT_EQ(plain_text(plain_text(all)), plain_text(all));
}

TEST(TextSafety, XmlHoldsIt) {
  EXPECT_EQ(xml_escaped("a<b>&\"\xFF"), "a&lt;b&gt;&amp;&quot;" + kGone);
}

}  // namespace
}  // namespace marey
