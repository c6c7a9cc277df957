#include "marey/calibrate/wand/wand_lens.h"

#include <gtest/gtest.h>

namespace marey::calibrate::wand {
namespace {

TEST(WandLens, AKnownLensIsTakenAsItIs) {
  RigCamera camera;
  camera.size = cv::Size(1920, 1080);
  camera.lens = geometry::FisheyeLens{{500, 510}, {950, 545}, {0.1, 0, 0, 0}};
  const geometry::Lens lens = starting_lens(camera, 1.2);
  const auto* fisheye = std::get_if<geometry::FisheyeLens>(&lens);
  ASSERT_NE(fisheye, nullptr);
  EXPECT_EQ(fisheye->focal, Vector<2>(500, 510));
  EXPECT_EQ(fisheye->distortion[0], 0.1);
}

TEST(WandLens, AnUnknownOneIsPlainAndLooksAtTheMiddle) {
  RigCamera camera;
  for (const cv::Size size : {cv::Size(1920, 1080), cv::Size(1080, 1920)}) {
    camera.size = size;
    const auto lens = std::get<geometry::BrownLens>(starting_lens(camera, 1.5));
    EXPECT_EQ(lens.focal, Vector<2>(2880, 2880)) << "of the longer side";
    EXPECT_EQ(lens.principal, Vector<2>((size.width - 1) / 2.0, (size.height - 1) / 2.0));
    for (const double coefficient : lens.distortion) EXPECT_EQ(coefficient, 0);
  }
}

TEST(WandLens, UncertainParametersMayMoveFarther) {
  const cv::Size size(1280, 1024);
  const auto growing = growing_lens(), estimated = estimated_lens(size), refined = refined_lens(size);
  EXPECT_EQ(growing.principal, 0) << "a growing rig does not specify it";
  EXPECT_EQ(estimated.focal, bundle::LensFreedom::free);
  EXPECT_EQ(refined.focal, bundle::LensFreedom::free);
  EXPECT_GT(estimated.distortion[0], refined.distortion[0]);
  EXPECT_EQ(estimated.principal, refined.principal);
  EXPECT_EQ(estimated_lens({2560, 1024}).principal, 2 * estimated.principal);
  for (std::size_t k = 4; k < 8; ++k) EXPECT_EQ(estimated.distortion[k], 0) << k;
}

}  // namespace
}  // namespace marey::calibrate::wand
