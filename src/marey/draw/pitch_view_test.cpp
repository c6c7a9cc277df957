#include "marey/draw/pitch_view.h"

#include <vector>

#include <gtest/gtest.h>

namespace marey::draw {
namespace {

PitchViewOptions options_with(bool y_down) {
  PitchViewOptions options;
  options.pitch = geometry::PitchSize{};
  options.y_down = y_down;
  return options;
}

cv::Vec3b colour_at(const Image& image, double x, double y) {
  return image.bgr().at<cv::Vec3b>(cvRound(y), cvRound(x));
}

TEST(PitchView, DrawsAPersonWhereTheyAre) {
  for (const bool y_down : {true, false}) {
    PitchView view(options_with(y_down));
    const std::vector<PitchView::Mark> marks = {{.number = 1, .text = "", .colour = {255, 0, 0}, .location = {21, 14}}};
    const Image image = view.draw(Timestamp{}, marks);
    ASSERT_EQ(image.size(), view.size());
    const double scale = 1280 / 111.0;
    const double x = 24 * scale, y = (y_down ? 17 : 57) * scale;
    EXPECT_GT(colour_at(image, x, y)[2], 200) << y_down;
    EXPECT_LT(colour_at(image, x, y)[1], 60) << y_down;
    EXPECT_LT(colour_at(image, x + 60, y)[2], 100) << y_down;
  }
}

TEST(PitchView, ShowsTheTrailAndForgetsIt) {
  PitchView view(options_with(true));
  const Image empty = view.draw(Timestamp{}, {});
  Image last = empty;
  for (int i = 0; i <= 10; ++i) {
    const std::vector<PitchView::Mark> marks = {{.number = 1, .text = "7", .colour = {255, 0, 0}, .location = {20.0 + i, 14}}};
    last = view.draw(Timestamp{} + std::chrono::milliseconds(100 * i), marks);
  }
  const double scale = 1280 / 111.0;
  EXPECT_GT(colour_at(last, 31 * scale, 17 * scale)[2], colour_at(empty, 31 * scale, 17 * scale)[2] + 60);
  const Image later = view.draw(Timestamp{} + std::chrono::seconds(10), {});
  EXPECT_EQ(cv::norm(later.luma(), empty.luma(), cv::NORM_INF), 0);
}

TEST(PitchView, DrawsOnlyInsideImage) {
  PitchView view(options_with(true));
  const Image empty = view.draw(Timestamp{}, {});
  const std::vector<PitchView::Mark> marks = {{.number = 1, .text = "7", .colour = {255, 0, 0}, .location = {-40, 300}}};
  EXPECT_EQ(cv::norm(view.draw(Timestamp{}, marks).luma(), empty.luma(), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace marey::draw
