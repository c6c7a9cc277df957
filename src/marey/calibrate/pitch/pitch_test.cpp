#include "marey/calibrate/pitch/pitch.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/pitch/pitch_deviation.h"
#include "marey/calibrate/pitch/pitch_sightings.h"
#include "marey/core/error.h"
#include "marey/core/geometry.h"
#include "marey/geometry/ground_view.h"

namespace marey::calibrate::pitch {
namespace {

constexpr geometry::PitchSize kDefaultPitch{105, 68};
const cv::Size kClickedSize(1536, 864);

/// On a stand at the half-way line, 15 m off, 8 m up, turned towards one goal; the world's y points away from the stand.
Camera rotated_on_the_stand(double turn) {
  const double tilt = 0.12;
  const Vector<3> ahead(std::sin(turn) * std::cos(tilt), std::cos(turn) * std::cos(tilt), -std::sin(tilt));
  const Vector<3> right = ahead.cross(Vector<3>::UnitZ()).normalized();
  Matrix<3> rotation;
  rotation << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  const geometry::BrownLens lens{{1050, 1050}, {772, 428}, {-0.33, 0.12, 0, 0, -0.015}};
  return {lens, {rotation, -rotation * Vector<3>(52, -15, 8)}, kClickedSize};
}

/// What a user clicks: corners and crossings in view, `sigma` px off. `left_handed`: his y grows towards the camera.
std::vector<PitchPoint> clicks(const Camera& camera, double sigma, bool left_handed, unsigned seed,
                               const geometry::GroundSurface& ground = {}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  std::vector<PitchPoint> points;
  for (const double x : {0.0, 5.5, 11.0, 16.5, 44.0, 52.5, 61.0, 88.5, 99.5, 105.0}) {
    for (const double y : {0.0, 13.84, 24.84, 34.0, 43.16, 54.16, 68.0}) {
      const auto pixel = camera.project({x, y, ground.height({x, y})});
      if (!pixel || !camera.in_image(*pixel)) continue;
      points.push_back(
          {{x, left_handed ? 68 - y : y}, *pixel + sigma * Vector<2>(noise(random), noise(random)), fmt::format("({},{})", x, y)});
    }
  }
  return points;
}

/// Grass with the lines painted on it: every pixel shows its own place on the ground, 4 × 4 times.
cv::Mat painted(const Camera& camera, const geometry::GroundSurface& ground = {}) {
  cv::Mat image(kClickedSize, CV_8UC1, cv::Scalar(90));
  const GroundView view(camera, ground);
  for (int y = 0; y < kClickedSize.height; ++y) {
    for (int x = 0; x < kClickedSize.width; ++x) {
      const auto middle = view.location({static_cast<double>(x), static_cast<double>(y)});
      if (!middle) continue;
      const double pixel = std::max(middle->by_pixel.col(0).norm(), middle->by_pixel.col(1).norm());
      if (pixel > 5 || geometry::distance_to_line(kDefaultPitch, middle->ground) > 0.06 + pixel) continue;
      int white = 0;
      for (int i = 0; i < 16; ++i) {
        const auto location = view.location({x - 0.375 + i % 4 * 0.25, y - 0.375 + i / 4 * 0.25});
        if (location) white += geometry::distance_to_line(kDefaultPitch, location->ground) < 0.06;
      }
      image.at<unsigned char>(y, x) = static_cast<unsigned char>(90 + 110 * white / 16);
    }
  }
  cv::GaussianBlur(image, image, {}, 0.7);
  return image;
}

/// Camera `index` of the result against the truth, m.
double worst_on_the_ground(const PitchCalibration& found, const GroundView& truth, bool left_handed, std::size_t index = 0) {
  const GroundView detected(found.views[index].camera, found.fit.ground);
  double worst = 0;
  for (double x = 0; x <= 52; x += 4) {
    for (double y = 0; y <= 60; y += 4) {
      const auto pixel = truth.pixel({x, y});
      if (!pixel || !truth.camera()->in_image(*pixel)) continue;
      const auto location = detected.location(*pixel);
      if (!location) return 1e9;
      const Vector<2> ground = (found.ground_from_world * location->ground.homogeneous()).hnormalized();
      worst = std::max(worst, (ground - Vector<2>(x, left_handed ? 68 - y : y)).norm());
    }
  }
  return worst;
}

TEST(PitchCalibration, PerfectClicksGiveTheCameraBack) {
  const Camera truth = rotated_on_the_stand(-0.45);
  for (const bool left_handed : {false, true}) {
    const auto result = calibrate_pitch({{"left", kClickedSize, clicks(truth, 0, left_handed, 1), {}, {}}}, {kDefaultPitch});
    EXPECT_EQ(result.ground_from_world(1, 1), left_handed ? -1 : 1);
    EXPECT_LT(worst_on_the_ground(result, GroundView(truth), left_handed), 0.15);
    EXPECT_GT(result.views[0].camera.centre().z(), 0) << "the camera faces down upon the pitch";
  }
}

TEST(PitchCalibration, LinesCorrectWhatClicksGetWrong) {
  const Camera truth = rotated_on_the_stand(-0.45);
  const cv::Mat ground = painted(truth);
  const auto points = clicks(truth, 2, true, 3);
  const auto clicked = calibrate_pitch({{"left", kClickedSize, points, {}, {}}}, {kDefaultPitch});
  const auto refined = calibrate_pitch({{"left", kClickedSize, points, {}, ground}}, {kDefaultPitch});
  const double before = worst_on_the_ground(clicked, GroundView(truth), true);
  const double after = worst_on_the_ground(refined, GroundView(truth), true);
  EXPECT_LT(after, 0.3);
  EXPECT_LT(after, before);
  EXPECT_GT(refined.views[0].lines.size(), 500u);
  EXPECT_LT(refined.views[0].line_median_m, 0.03);
}

/// Two cameras of one stand, clicked in with a gross one among it, and their images.
std::vector<PitchView> two_views(const geometry::GroundSurface& ground) {
  std::vector<PitchView> views;
  for (const double turn : {-0.45, 0.45}) {
    const Camera truth = rotated_on_the_stand(turn);
    PitchView& view = views.emplace_back(
        PitchView{turn < 0 ? "left" : "right", kClickedSize, clicks(truth, 1, true, 5, ground), {}, painted(truth, ground)});
    view.points[2].pixel += Vector<2>(70, -50);
  }
  return views;
}

TEST(PitchCalibration, ACrownIsNotLeftToTheLens) {
  const geometry::GroundSurface crowned{.middle = {52.5, 34}, .half = {52.5, 34}, .across = 0.3, .along = 0.2};
  const auto views = two_views(crowned);
  const auto found = calibrate_pitch(views, {.size = kDefaultPitch});
  const auto level = calibrate_pitch(views, {.size = kDefaultPitch, .known = GroundKnown::level});
  EXPECT_NEAR(found.fit.ground.height(found.fit.ground.middle), 0.5, 0.05);
  EXPECT_TRUE(level.fit.ground.flat());
  for (std::size_t i = 0; i < 2; ++i) {
    const GroundView truth(rotated_on_the_stand(i == 0 ? -0.45 : 0.45), crowned);
    EXPECT_LT(worst_on_the_ground(found, truth, true, i), 0.35) << views[i].name;
    EXPECT_GT(worst_on_the_ground(level, truth, true, i), 0.7) << "or there would be nothing to show";
    EXPECT_NEAR(geometry::focal_of(found.views[i].camera.lens()).x(), 1050, 5);
    EXPECT_EQ(std::count(found.views[i].inlier.begin(), found.views[i].inlier.end(), 0), 1);
    EXPECT_FALSE(found.views[i].inlier[2]);
    const auto unsure = position_covariance(found.fit, i, found.fit.ground.middle);
    ASSERT_TRUE(unsure);
    EXPECT_GT(unsure->trace(), 0);
    EXPECT_LT(std::sqrt(unsure->trace()), 0.3);
  }
  const auto kept = calibrate_pitch({views[0]}, {.size = kDefaultPitch, .known = GroundKnown::wholly, .ground = found.fit.ground});
  EXPECT_EQ(kept.fit.ground.terms(), found.fit.ground.terms());
}

TEST(PitchCalibration, ALevelPitchStaysLevel) {
  const auto found = calibrate_pitch(two_views({}), {.size = kDefaultPitch});
  EXPECT_LT(std::abs(found.fit.ground.height(found.fit.ground.middle)), 0.03);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT(worst_on_the_ground(found, GroundView(rotated_on_the_stand(i == 0 ? -0.45 : 0.45)), true, i), 0.3);
}

TEST(PitchCalibration, ClickedLinesHoldWhatFewPointsLeaveOpen) {
  const Camera truth = rotated_on_the_stand(-0.45);
  std::vector<PitchPoint> few;
  for (const PitchPoint& point : clicks(truth, 1.5, true, 7)) {
    if (few.size() < 8) few.push_back(point);
  }
  std::vector<PitchClickedLine> lines;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1.5);
  for (const auto& [from, to] :
       {std::pair<Vector<2>, Vector<2>>{{0, 0}, {105, 0}}, {{0, 68}, {105, 68}}, {{52.5, 0}, {52.5, 68}}}) {
    PitchClickedLine& line = lines.emplace_back(PitchClickedLine{from, to, {}});
    for (double t = 0; t <= 1; t += 0.05) {
      const Vector<2> location = from + t * (to - from);
      const auto pixel = truth.project({location.x(), 68 - location.y(), 0});
      if (pixel && truth.in_image(*pixel)) line.pixels.push_back(*pixel + Vector<2>(noise(random), noise(random)));
    }
  }
  const auto without = calibrate_pitch({{"left", kClickedSize, few, {}, {}}}, {kDefaultPitch});
  const auto with = calibrate_pitch({{"left", kClickedSize, few, lines, {}}}, {kDefaultPitch});
  EXPECT_LT(worst_on_the_ground(with, GroundView(truth), true), 0.5 * worst_on_the_ground(without, GroundView(truth), true));
}

/// Eight clicks: whatever their noise, what comes out is a camera that faces down upon them, and the side that y grows to.
TEST(PitchCalibration, FewPointsAreEnough) {
  const Camera truth = rotated_on_the_stand(-0.45);
  for (unsigned seed = 1; seed <= 15; ++seed) {
    SCOPED_TRACE(seed);
    const bool left_handed = seed % 2 == 0;
    auto few = clicks(truth, 1.5, left_handed, seed);
    std::shuffle(few.begin(), few.end(), std::mt19937(seed));
    few.resize(8);
    EXPECT_EQ(is_left_handed("left", few, kClickedSize), left_handed);
    const auto found = calibrate_pitch({{"left", kClickedSize, few, {}, {}}}, {kDefaultPitch});
    EXPECT_LT(*std::max_element(found.views[0].error_px.begin(), found.views[0].error_px.end()), 10);
  }
}

/// All but one or two on the goal line: a camera under the ground explains them nearly as well, and noise may decide for it.
TEST(PitchCalibration, PointsAlongOneLineMostlyTellTheHand) {
  const Camera truth = rotated_on_the_stand(-0.45);
  int wrong = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    auto few = clicks(truth, 1.5, seed % 2 == 0, seed);
    few.resize(8);
    wrong += is_left_handed("left", few, kClickedSize) != (seed % 2 == 0);
  }
  EXPECT_LE(wrong, 1);
}

TEST(PitchCalibration, WrongNamesAreFoundAndNamed) {
  const Camera truth = rotated_on_the_stand(-0.45);
  auto points = clicks(truth, 1, true, 5);
  ASSERT_GT(points.size(), 15u);
  const Vector<2> right_place = points[3].ground;
  points[3].ground.y() = 68 - points[3].ground.y() == points[3].ground.y() ? 0 : 68 - points[3].ground.y();
  points[9].pixel += Vector<2>(60, -40);
  const auto result = calibrate_pitch({{"left", kClickedSize, points, {}, {}}}, {kDefaultPitch});
  const auto& view = result.views[0];
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(view.inlier[i] != 0, i != 3 && i != 9) << i << " " << view.error_px[i];
  ASSERT_TRUE(view.better_name[3]);
  EXPECT_LT((*view.better_name[3] - right_place).norm(), 1e-9);
}

std::string error_of(const std::vector<PitchView>& views) {
  try {
    calibrate_pitch(views, {kDefaultPitch});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PitchCalibration, RejectsImpossibleCalibrationWithCause) {
  const Camera left = rotated_on_the_stand(-0.45), right = rotated_on_the_stand(0.45);
  auto three = clicks(left, 0, true, 1);
  three.resize(3);
  EXPECT_NE(error_of({{"left", kClickedSize, three, {}, {}}}).find("at least 4"), std::string::npos);
  std::vector<PitchPoint> line;
  for (const PitchPoint& point : clicks(left, 0, true, 1)) {
    if (point.ground.x() == 0) line.push_back(point);
  }
  EXPECT_NE(error_of({{"left", kClickedSize, line, {}, {}}}).find("on one line"), std::string::npos);
  auto mirrored = clicks(right, 0, true, 1);
  for (PitchPoint& point : mirrored) point.ground.x() = 105 - point.ground.x();
  EXPECT_NE(error_of({{"left", kClickedSize, clicks(left, 0, true, 1), {}, {}}, {"right", kClickedSize, mirrored, {}, {}}})
                .find("mirrored"),
            std::string::npos);
  EXPECT_EQ(error_of({{"left", kClickedSize, clicks(left, 0, true, 1), {}, {}},
                      {"right", kClickedSize, clicks(right, 0, true, 1), {}, {}}}),
            "");
  std::vector<PitchPoint> nonsense = clicks(left, 0, true, 1);
  std::mt19937 random(11);
  for (PitchPoint& point : nonsense) point.pixel = Vector<2>(random() % 1536, random() % 864);
  EXPECT_NE(error_of({{"left", kClickedSize, nonsense, {}, {}}}), "");
}

}  // namespace
}  // namespace marey::calibrate::pitch
