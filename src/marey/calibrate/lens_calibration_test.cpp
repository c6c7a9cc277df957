#include "marey/calibrate/lens_calibration.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/calibrate/board_scene_test.h"
#include "marey/core/error.h"

namespace marey {
namespace {

const Board kBoard = parse_board("chess:9x6:0.03");
constexpr int kWidth = 1280, kHeight = 960;

std::vector<LensView> views_by(const Lens& lens, std::uint64_t seed, int count, double noise_px, double most_tilt = 0.6,
                               double distance = 0.35) {
  Noise noise(seed);
  const Camera camera(lens, {}, {kWidth, kHeight});
  std::vector<LensView> views;
  while (static_cast<int>(views.size()) < count) {
    const Vector<3> turn(noise.uniform(-most_tilt, most_tilt), noise.uniform(-most_tilt, most_tilt),
                         noise.uniform(-most_tilt, most_tilt));
    const double far = distance * noise.uniform(1, 2.5);
    const Vector<3> place(noise.uniform(-0.5, 0.5) * far, noise.uniform(-0.4, 0.4) * far, far);
    const Rigid3 pose{rotation_from(turn), place - rotation_from(turn) * Vector<3>(0.12, 0.075, 0)};
    auto view = see_board(camera, kBoard, [&](double) { return pose; }, noise_px, noise);
    if (view) views.push_back({"picture " + std::to_string(views.size()), std::move(*view)});
  }
  return views;
}

std::string refusal(std::span<const LensView> views) {
  try {
    calibrate_lens(kBoard, {kWidth, kHeight}, views);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CalibrateLens, TruthIsWithinTheDeviationsOfEveryModel) {
  const std::vector<Lens> lenses{BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0.001, -0.0007, 0.01, 0, 0, 0}},
                                 FisheyeLens{{500, 505}, {630, 490}, {-0.02, 0.004, 0.001, -0.0005}},
                                 TsaiLens{{1100, 1100}, {640, 480}, {0.2}}};
  for (const Lens& lens : lenses) {
    const double distance = std::holds_alternative<FisheyeLens>(lens) ? 0.2 : 0.35;
    LensOptions options;
    options.model = name_of(lens);
    double square = 0;  // of errors in standard deviations: three numbers, six seeds
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views_by(lens, seed, 15, 0.2, 0.6, distance), options);
      const double truth = focal_of(lens).x();
      const Vector<2> off = (principal_of(found.lens) - principal_of(lens)).cwiseQuotient(found.deviation.principal);
      square += std::pow((focal_of(found.lens).x() / truth - 1) / found.deviation.focal, 2) + off.squaredNorm();
      EXPECT_NEAR(found.noise_px, 0.2, 0.02) << options.model;
      EXPECT_EQ(found.inliers, found.observations);
    }
    EXPECT_GT(square / 18, 0.27) << options.model;  // χ² of 18 over 18: outside once in a thousand
    EXPECT_LT(square / 18, 2.4) << options.model;
  }
}

TEST(CalibrateLens, ABadViewIsRefusedAndNamed) {
  const Lens lens = BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0, 0, 0, 0, 0, 0}};
  auto views = views_by(lens, 4, 15, 0.1);
  Noise noise(99);
  for (BoardCorner& corner : views[3].board.corners) corner.pixel += Vector<2>(noise.gaussian(4), noise.gaussian(4));
  const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views);
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(found.views[i].refused.empty(), i != 3) << i;
  EXPECT_NEAR(focal_of(found.lens).x(), 1100, 4 * found.deviation.focal * 1100);
}

TEST(CalibrateLens, SingleWrongCornersArePutOut) {
  const Lens lens = BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0, 0, 0, 0, 0, 0}};
  auto views = views_by(lens, 4, 15, 0.1);
  views[2].board.corners[7].pixel.x() += 3;
  views[9].board.corners[50].pixel.y() -= 5;
  const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views);
  EXPECT_EQ(found.inliers, found.observations - 2);
}

TEST(CalibrateLens, WhatCannotTellALensIsRefusedWithTheRemedy) {
  const Lens lens = BrownLens{{1100, 1100}, {640, 480}, {}};
  EXPECT_NE(refusal(views_by(lens, 1, 2, 0.1)).find("seen in 2 pictures, and a lens needs 3"), std::string::npos);
  const std::string parallel = refusal(views_by(lens, 1, 12, 0.1, 0.0));
  EXPECT_NE(parallel.find("tilt it by 30"), std::string::npos) << parallel;
}

TEST(CalibrateLens, FewAndFlatViewsAreWarnedOf) {
  const Lens lens = BrownLens{{1100, 1100}, {640, 480}, {}};
  const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views_by(lens, 1, 5, 0.1, 0.15));
  EXPECT_GE(found.warnings.size(), 2U);
}

}  // namespace
}  // namespace marey
