#include "marey/core/time.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(Time, SecondsAndNanosecondsAgree) {
  EXPECT_EQ(duration_from_seconds(0.04), Duration(40'000'000));
  EXPECT_DOUBLE_EQ(seconds(timestamp_from_seconds(1.0 / 3.0)), 0.333333333);
  EXPECT_EQ(timestamp_from_seconds(-0.5).time_since_epoch(), Duration(-500'000'000));
}

}  // namespace
}  // namespace marey
