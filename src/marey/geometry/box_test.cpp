#include "marey/geometry/box.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

TEST(Box, CentreAndFootFollowThePixelConvention) {
  const Box one_pixel{4, 7, 1, 1};
  EXPECT_EQ(one_pixel.centre(), Vector<2>(4, 7));
  EXPECT_EQ(one_pixel.foot(), Vector<2>(4, 7.5));
  const Box box{10, 20, 4, 6};
  EXPECT_EQ(Box::from_centre(box.centre(), 4, 6), box);
}

TEST(Box, OverlapOfKnownRectangles) {
  const Box a{0, 0, 4, 4};
  EXPECT_DOUBLE_EQ(iou(a, a), 1.0);
  EXPECT_DOUBLE_EQ(iou(a, {2, 0, 4, 4}), 8.0 / 24.0);
  EXPECT_DOUBLE_EQ(iou(a, {4, 0, 4, 4}), 0.0);
  EXPECT_DOUBLE_EQ(iou(a, {0, 0, 0, 0}), 0.0);
  EXPECT_EQ(hull(a, {6, 1, 2, 9}), (Box{0, 0, 8, 10}));
}

}  // namespace
}  // namespace marey::geometry
