#include "marey/stream/bytes.h"

#include <gtest/gtest.h>

namespace marey::stream {
namespace {

TEST(Bytes, NumbersStandInTheOrderOfTheWire) {
  LittleBytes little;
  little.put<std::uint32_t>(0x01020304u).put<std::int16_t>(std::int16_t{-2}).text("ab");
  EXPECT_EQ(little.str(), std::string("\x04\x03\x02\x01\xfe\xff"
                                      "ab\0",
                                      9));
  BigBytes big;
  big.put<std::uint16_t>(std::uint16_t{0x0102}).put<float>(1.0F);
  EXPECT_EQ(big.str(), std::string("\x01\x02\x3f\x80\0\0", 6));
  little.set<std::uint32_t>(0, 7);
  EXPECT_EQ(number_at<std::uint32_t>(little.str(), 0), 7u);
}

TEST(Bytes, RejectsTruncatedNumber) {
  EXPECT_FALSE(number_at<std::uint32_t>("abc", 0));
  EXPECT_FALSE(number_at<std::uint16_t>("abc", 2));
  EXPECT_FALSE(number_at<std::uint16_t>("abc", std::size_t(-1)));
  EXPECT_EQ((number_at<std::uint16_t, std::endian::big>("abc", 1)), 0x6263);
}

}  // namespace
}  // namespace marey::stream
