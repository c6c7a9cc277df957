#include "marey/track/image/view_border.h"

#include <gtest/gtest.h>

namespace marey::track::image {
namespace {

TEST(ViewBorder, IsWhereBoxesInSeveralPlacesEnd) {
  ViewBorder border;
  for (const double top : {100.0, 250.0, 400.0}) {
    border.observe_frame({0.4, top, 30, 90});
    border.observe_frame({600, top, 40, 90});  // to 640
  }
  const auto view = border.view();
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->left, 0.4, 1e-9);
  EXPECT_NEAR(view->right(), 640, 1e-6);
  EXPECT_LT(view->top, -1e6) << "no box ended there in several places";
}

TEST(ViewBorder, OutermostPersonIsNoBorder) {
  ViewBorder border;
  for (int frame = 0; frame < 100; ++frame) border.observe_frame({20, 100, 30, 90});
  border.observe_frame({60, 300, 30, 90});
  border.observe_frame({90, 400, 30, 90});
  const auto view = border.view();
  EXPECT_TRUE(!view || view->left < -1e6);
  EXPECT_FALSE(ViewBorder().view());
}

}  // namespace
}  // namespace marey::track::image
