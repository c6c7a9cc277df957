#include "marey/core/frame_numbers.h"

#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

std::string stated(const FrameNumbers& frames) {
  try {
    frames.check("a.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FrameNumbers, ReportsOutlierNumber) {
  FrameNumbers frames;
  for (const std::int64_t frame : {0, 1, 1, 2, 3, 1'000'000'000}) frames.add(frame);
  EXPECT_EQ(stated(frames), "a.csv: frames 0 to 1000000000 are named, of which 5 are there; a number must be wrong");
}

TEST(FrameNumbers, GapsOfADayPassAndSoDoesNothing) {
  FrameNumbers frames;
  EXPECT_EQ(stated(frames), "");
  frames.add(900'000'000);
  frames.add(900'000'000 + FrameNumbers::kMaxMissing);
  EXPECT_EQ(stated(frames), "");
}

TEST(FrameNumbers, TheRateIsThatOfTheMedianStepAndAsExactAsTheSpan) {
  FrameNumbers frames;
  for (int i = 0; i < 1000; ++i) {
    if (i % 7 == 3) continue;  // gaps change nothing
    frames.add(i, static_cast<double>(static_cast<int>(i / 119.88 * 1e4)) / 1e4);
  }
  EXPECT_NEAR(frames.rate_hz().value(), 119.88, 2e-3);
}

TEST(FrameNumbers, OutlierTimeKeepsRate) {
  for (const double wild : {1e9, -1e9, 0.0}) {
    FrameNumbers frames;
    for (int i = 0; i < 100; ++i) frames.add(i, i == 99 || i == 40 ? wild : i / 25.0);
    EXPECT_NEAR(frames.rate_hz().value(), 25, 1e-9) << wild;
  }
}

TEST(FrameNumbers, WithoutTimesOrWithTimesThatStandThereIsNoRate) {
  FrameNumbers without, standing, backwards;
  for (int i = 0; i < 5; ++i) {
    without.add(i);
    standing.add(i, 3.0);
    backwards.add(i, -i);
  }
  EXPECT_FALSE(without.rate_hz());
  EXPECT_FALSE(standing.rate_hz());
  EXPECT_FALSE(backwards.rate_hz());
}

}  // namespace
}  // namespace marey
