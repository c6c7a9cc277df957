#include "marey/pipeline/people/ground/mosaic.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/simulate/match/ptz_match.h"

namespace marey::pipeline::people::ground {
namespace {

using marey::simulate::match::PtzMatch;
using marey::simulate::match::PtzMatchOptions;

PtzMatchOptions mosaic_match(bool people) {
  PtzMatchOptions options;
  options.size = {640, 360};
  options.people = people;
  options.scoreboard = false;
  options.exposure = 0;
  options.rate_hz = 2;
  return options;
}

/// A mosaic of a match with people in it shows, from any aim, nearly the image without them.
TEST(Mosaic, ShowsTheEmptySceneFromEveryAim) {
  PtzMatch match(mosaic_match(true), 4), empty(mosaic_match(false), 4);
  PtzCamera camera{match.tripod(), {}};
  std::vector<cv::Mat> images, without;
  for (int i = 0; i < 16; ++i) {
    match.advance(), empty.advance();
    images.push_back(match.image().luma());
    without.push_back(empty.image().luma());
    camera.rotations.push_back({match.time(), match.heading(), Matrix<3>::Zero(), std::nullopt});
  }
  Mosaic mosaic(camera, mosaic_match(true).size);
  for (std::size_t i = 0; i < images.size(); ++i) mosaic.add(images[i], *camera.rotations[i].heading);
  mosaic.finish();
  for (const std::size_t i : {std::size_t{3}, std::size_t{12}}) {
    const cv::Mat scene = mosaic.scene(*camera.rotations[i].heading);
    const cv::Mat grass(scene, cv::Rect(0, 200, 640, 150));
    const cv::Mat known = grass > 0;
    EXPECT_GT(cv::countNonZero(known), 0.95 * 640 * 150) << i;
    const cv::Mat bare = without[i](cv::Rect(0, 200, 640, 150)), crowded = images[i](cv::Rect(0, 200, 640, 150));
    cv::Mat off_mosaic, off_image, low, high;
    cv::absdiff(grass, bare, off_mosaic);
    cv::absdiff(crowded, bare, off_image);
    EXPECT_LT(cv::mean(off_mosaic, known)[0], 6) << i;
    // Paint is a pixel wide: what counts is that nothing is there which is not close by.
    cv::erode(bare, low, cv::Mat::ones(3, 3, CV_8U)), cv::dilate(bare, high, cv::Mat::ones(3, 3, CV_8U));
    const cv::Mat strange = known & ((grass > high + 25) | (grass < low - 25));
    EXPECT_LT(cv::countNonZero(strange), 0.003 * 640 * 150) << i;
    const cv::Mat people = off_image > 40, shown = people & (off_mosaic > 30);
    EXPECT_LE(cv::countNonZero(shown), 0.3 * cv::countNonZero(people) + 5) << i;
  }
}

}  // namespace
}  // namespace marey::pipeline::people::ground
