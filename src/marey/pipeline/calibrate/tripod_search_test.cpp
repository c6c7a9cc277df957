#include "marey/calibrate/ptz/tripod_search.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/geometry/ground_view.h"
#include "marey/simulate/match/ptz_match.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::ptz::SearchedTripod;
using marey::calibrate::ptz::SearchImage;
using marey::calibrate::ptz::TripodVerdict;
using marey::simulate::match::PtzMatch;
using marey::simulate::match::PtzMatchOptions;

PtzMatchOptions searched_match() {
  PtzMatchOptions options;
  options.size = {640, 360};
  options.people = false;
  options.rate_hz = 2;
  return options;
}

SearchImage searched_image(std::int64_t frame, const Image& image) {
  return {frame, image, marey::calibrate::ptz::distinct_lines(marey::calibrate::ptz::paint_mask(image))};
}

TEST(TripodSearch, ImagesAloneGiveTheTripodAndWhereTheyFace) {
  PtzMatch match(searched_match(), 3);
  std::vector<SearchImage> images;
  std::vector<geometry::Heading> truth;
  for (int i = 0; i < 6; ++i) {
    match.advance();
    images.push_back(searched_image(i, match.image()));
    truth.push_back(*match.heading());
  }
  const SearchedTripod found = marey::calibrate::ptz::search_tripod(images, {});
  ASSERT_EQ(found.verdict, TripodVerdict::found);
  EXPECT_GE(found.views.size(), 4u);
  EXPECT_LT(found.rival, 0.75 * found.merit);
  for (const auto& view : found.views) {
    const geometry::GroundView is(
        geometry::camera_of(match.tripod(), truth[static_cast<std::size_t>(view.frame)], searched_match().size)),
        was(geometry::camera_of(found.tripod, view.heading, searched_match().size));
    const Vector<2> low(320, 250);
    ASSERT_TRUE(is.location(low) && was.location(low));
    EXPECT_LT((is.location(low)->ground - was.location(low)->ground).norm(), 0.5) << view.frame;
  }
}

TEST(TripodSearch, AnImageWithoutAPitchGivesNone) {
  cv::Mat grass(360, 640, CV_8UC3, cv::Scalar(72, 110, 92));
  cv::randn(grass, cv::Scalar(72, 110, 92), cv::Scalar(6, 6, 6));
  const std::vector<SearchImage> images{searched_image(0, Image::from_bgr(grass))};
  EXPECT_EQ(marey::calibrate::ptz::search_tripod(images, {}).verdict, TripodVerdict::no_lines);
}

/// Straight white lines all over the grass, of no pitch.
TEST(TripodSearch, LinesOfNoPitchGiveNone) {
  std::vector<SearchImage> images;
  cv::RNG random(5);
  for (int i = 0; i < 5; ++i) {
    cv::Mat grass(360, 640, CV_8UC3);
    cv::randn(grass, cv::Scalar(72, 110, 92), cv::Scalar(6, 6, 6));
    for (int k = 0; k < 9; ++k)
      cv::line(grass, {random.uniform(0, 640), random.uniform(0, 360)}, {random.uniform(0, 640), random.uniform(0, 360)},
               {210, 215, 210}, 2, cv::LINE_AA);
    images.push_back(searched_image(i, Image::from_bgr(grass)));
  }
  EXPECT_NE(marey::calibrate::ptz::search_tripod(images, {}).verdict, TripodVerdict::found);
}

}  // namespace
}  // namespace marey::pipeline::calibrate
