#include <gtest/gtest.h>

#include "marey/stream/osc_message.h"

namespace marey::stream {
namespace {

TEST(Osc, AMessageIsPaddedToFourBytes) {
  EXPECT_EQ(OscMessage("/a").i(1).s("abcd").f(1).bytes(), std::string("/a\0\0,isf\0\0\0\0\0\0\0\1abcd\0\0\0\0\x3f\x80\0\0", 28));
  EXPECT_EQ(OscMessage("/abc").h(-1).d(0).bytes(),
            std::string("/abc\0\0\0\0,hd\0\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0\0\0\0\0", 28));
}

TEST(Osc, ATextEndsAtItsFirstNul) {
  EXPECT_EQ(OscMessage("/a").s(std::string_view("x\0y", 3)).bytes(), std::string("/a\0\0,s\0\0x\0\0\0", 12));
}

TEST(Osc, BundlesHoldWhatFitsAndLoseNothing) {
  const std::vector<std::string> messages(10, OscMessage("/a").i(1).bytes());  // 12 bytes, 16 in a bundle
  EXPECT_EQ(osc_bundles(messages, 1000).size(), 1u);
  EXPECT_EQ(osc_bundles(messages, 1000)[0].size(), 16u + 10 * 16);
  EXPECT_TRUE(osc_bundles(messages, 1000)[0].starts_with(std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\x0c/a", 22)));
  const auto small = osc_bundles(messages, 64);
  EXPECT_EQ(small.size(), 4u);  // three each
  for (const std::string& bundle : small) EXPECT_LE(bundle.size(), 64u);
  EXPECT_EQ(osc_bundles(messages, 1).size(), 10u);
  EXPECT_TRUE(osc_bundles({}, 64).empty());
}

}  // namespace
}  // namespace marey::stream
