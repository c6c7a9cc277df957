#include "marey/calibrate/lens_calibration.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"
#include "marey/core/error.h"

namespace marey::calibrate {
namespace {

const board::Board kBoard = board::parse_board("chess:9x6:0.03");
constexpr int kWidth = 1280, kHeight = 960;

std::vector<LensView> views_by(const geometry::Lens& lens, std::uint64_t seed, int count, double noise_px, double most_tilt = 0.6,
                               double distance = 0.35) {
  board::Noise noise(seed);
  const Camera camera(lens, {}, {kWidth, kHeight});
  std::vector<LensView> views;
  while (static_cast<int>(views.size()) < count) {
    const Vector<3> turn(noise.uniform(-most_tilt, most_tilt), noise.uniform(-most_tilt, most_tilt),
                         noise.uniform(-most_tilt, most_tilt));
    const double far = distance * noise.uniform(1, 2.5);
    const Vector<3> location(noise.uniform(-0.5, 0.5) * far, noise.uniform(-0.4, 0.4) * far, far);
    const Rigid3 pose{geometry::rotation_from(turn), location - geometry::rotation_from(turn) * Vector<3>(0.12, 0.075, 0)};
    auto view = board::observe_board(camera, kBoard, [&](double) { return pose; }, noise_px, noise);
    if (view) views.push_back({"image " + std::to_string(views.size()), std::move(*view)});
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
  const std::vector<geometry::Lens> lenses{
      geometry::BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0.001, -0.0007, 0.01, 0, 0, 0}},
      geometry::FisheyeLens{{500, 505}, {630, 490}, {-0.02, 0.004, 0.001, -0.0005}},
      geometry::TsaiLens{{1100, 1100}, {640, 480}, {0.2}}};
  for (const geometry::Lens& lens : lenses) {
    const double distance = std::holds_alternative<geometry::FisheyeLens>(lens) ? 0.2 : 0.35;
    LensOptions options;
    options.model = geometry::name_of(lens);
    double square = 0;  // of errors in standard deviations: three numbers, six seeds
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views_by(lens, seed, 15, 0.2, 0.6, distance), options);
      const double truth = geometry::focal_of(lens).x();
      const Vector<2> off =
          (geometry::principal_of(found.lens) - geometry::principal_of(lens)).cwiseQuotient(found.deviation.principal);
      square += std::pow((geometry::focal_of(found.lens).x() / truth - 1) / found.deviation.focal, 2) + off.squaredNorm();
      EXPECT_NEAR(found.noise_px, 0.2, 0.02) << options.model;
      EXPECT_EQ(found.inliers, found.observations);
    }
    EXPECT_GT(square / 18, 0.27) << options.model;  // χ² of 18 over 18: outside once in a thousand
    EXPECT_LT(square / 18, 2.4) << options.model;
  }
}

TEST(CalibrateLens, ABadViewIsRefusedAndNamed) {
  const geometry::Lens lens = geometry::BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0, 0, 0, 0, 0, 0}};
  auto views = views_by(lens, 4, 15, 0.1);
  board::Noise noise(99);
  for (board::BoardCorner& corner : views[3].board.corners) corner.pixel += Vector<2>(noise.gaussian(4), noise.gaussian(4));
  const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views);
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(found.views[i].refused.empty(), i != 3) << i;
  EXPECT_NEAR(geometry::focal_of(found.lens).x(), 1100, 4 * found.deviation.focal * 1100);
}

TEST(CalibrateLens, SingleWrongCornersArePutOut) {
  const geometry::Lens lens = geometry::BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0, 0, 0, 0, 0, 0}};
  auto views = views_by(lens, 4, 15, 0.1);
  views[2].board.corners[7].pixel.x() += 3;
  views[9].board.corners[50].pixel.y() -= 5;
  const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views);
  EXPECT_EQ(found.inliers, found.observations - 2);
}

TEST(CalibrateLens, RejectsViewsThatDoNotDetermineLens) {
  const geometry::Lens lens = geometry::BrownLens{{1100, 1100}, {640, 480}, {}};
  EXPECT_NE(refusal(views_by(lens, 1, 2, 0.1)).find("seen in 2 images, and a lens needs 3"), std::string::npos);
  const std::string parallel = refusal(views_by(lens, 1, 12, 0.1, 0.0));
  EXPECT_NE(parallel.find("tilt it by 30"), std::string::npos) << parallel;
}

TEST(CalibrateLens, FewAndFlatViewsAreWarnedOf) {
  const geometry::Lens lens = geometry::BrownLens{{1100, 1100}, {640, 480}, {}};
  const auto found = calibrate_lens(kBoard, {kWidth, kHeight}, views_by(lens, 1, 5, 0.1, 0.15));
  EXPECT_GE(found.warnings.size(), 2U);
}

}  // namespace
}  // namespace marey::calibrate
