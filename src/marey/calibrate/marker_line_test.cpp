#include "marey/calibrate/marker_line.h"

#include <gtest/gtest.h>

namespace marey::calibrate {
namespace {

TEST(MarkerLine, IsReversibleWhereItsMiddleIsInTheMiddle) {
  EXPECT_TRUE((MarkerLine{{0, 0.3}}).reversible());
  EXPECT_TRUE((MarkerLine{{0, 0.15, 0.3}}).reversible());
  EXPECT_FALSE((MarkerLine{{0, 0.12, 0.3}}).reversible());
  EXPECT_FALSE((MarkerLine{{0}}).reversible());
}

}  // namespace
}  // namespace marey::calibrate
