#include "marey/calibrate/pitch/pitch_camera.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"
#include "marey/core/error.h"

namespace marey::calibrate::pitch {
namespace {

using board::Noise;

const cv::Size kSize(1536, 864);

/// On a stand, aimed at one half; the world's y points away from it.
Camera on_the_stand(double bend = -0.3) {
  return {geometry::BrownLens{{1050, 1050}, {767.5, 431.5}, {bend, 0.1}}, board::facing({52, -20, 10}, {35, 34, 0}), kSize};
}

/// Places every few metres that it sees, `sigma` px off.
std::vector<PitchPoint> points_of(const Camera& camera, double sigma, Noise& noise, bool mirrored = false) {
  std::vector<PitchPoint> points;
  for (double x = 0; x <= 105; x += 10.5) {
    for (double y = 0; y <= 68; y += 13.6) {
      const auto pixel = camera.project({x, y, 0});
      if (!pixel || !camera.in_image(*pixel)) continue;
      points.push_back({{x, mirrored ? 68 - y : y}, *pixel + Vector<2>(noise.gaussian(sigma), noise.gaussian(sigma)), ""});
    }
  }
  return points;
}

double worst_px(const Camera& found, const std::vector<PitchPoint>& exact) {
  double worst = 0;
  for (const PitchPoint& point : exact) {
    const auto pixel = found.project({point.ground.x(), point.ground.y(), 0});
    worst = std::max(worst, pixel ? (*pixel - point.pixel).norm() : 1e9);
  }
  return worst;
}

std::string refusal_of(const std::vector<PitchPoint>& points) {
  try {
    camera_from_points("left", points, kSize);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(PitchCamera, PointsGiveTheCamera) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const double bend : {0.0, -0.3}) {
      SCOPED_TRACE(testing::Message() << seed << " " << bend);
      Noise noise(seed);
      const Camera truth = on_the_stand(bend);
      const auto exact = points_of(truth, 0, noise);
      ASSERT_GT(exact.size(), 15U);
      const PitchCamera found = camera_from_points("left", points_of(truth, 0.7, noise), kSize);
      EXPECT_LT(worst_px(found.camera, exact), 4);
      EXPECT_LT((found.camera.centre() - truth.centre()).norm(), 3);
      EXPECT_GT(found.camera.centre().z(), 0);
      EXPECT_EQ(found.inlier.size(), found.error_px.size());
    }
  }
}

TEST(PitchCamera, WrongPointsAreNoInliers) {
  Noise noise(4);
  const Camera truth = on_the_stand();
  auto points = points_of(truth, 0.5, noise);
  points[2].pixel += Vector<2>(80, 30);
  points[7].ground += Vector<2>(0, 12);
  const PitchCamera found = camera_from_points("left", points, kSize);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(found.inlier[i] != 0, i != 2 && i != 7) << i;
  EXPECT_NEAR(found.error_px[2], std::hypot(80, 30), 8);
}

TEST(PitchCamera, AMirroredFrameIsTold) {
  Noise noise(5);
  EXPECT_FALSE(is_left_handed("left", points_of(on_the_stand(), 0.5, noise), kSize));
  EXPECT_TRUE(is_left_handed("left", points_of(on_the_stand(), 0.5, noise, true), kSize));
}

TEST(PitchCamera, PointsThatDecideNoCameraAreRefused) {
  Noise noise(6);
  auto points = points_of(on_the_stand(), 0, noise);
  EXPECT_EQ(refusal_of(points), "");
  EXPECT_EQ(refusal_of({points.begin(), points.begin() + 3}).substr(0, 5), "left:");
  auto line = points;
  std::erase_if(line, [](const PitchPoint& point) { return point.ground.y() != 34 && point.ground.y() != 40.8; });
  for (PitchPoint& point : line) point.ground.y() = 34;
  EXPECT_NE(refusal_of(line), "");
  for (PitchPoint& point : points) point.pixel = Vector<2>(noise.uniform(0, 1535), noise.uniform(0, 863));
  EXPECT_NE(refusal_of(points), "");
}

TEST(PitchCamera, SightingsOfLinesPullTheCameraRight) {
  Noise noise(7);
  const Camera truth = on_the_stand();
  const auto exact = points_of(truth, 0, noise);
  const PitchCamera start = camera_from_points("left", points_of(truth, 3, noise), kSize);
  std::vector<LineSighting> sightings;
  const auto add = [&](const Vector<2>& ground, const Vector<2>& along, int line) {
    const auto here = truth.project({ground.x(), ground.y(), 0});
    const auto there = truth.project({ground.x() + along.x(), ground.y() + along.y(), 0});
    if (!here || !there || !truth.in_image(*here)) return;
    const Vector<2> direction = (*there - *here).normalized();
    sightings.push_back({ground, *here, {-direction.y(), direction.x()}, 20, 0.35, line});
  };
  for (double t = 0; t <= 1; t += 0.01) {
    add({105 * t, 0}, {0.01, 0}, 0);
    add({105 * t, 68}, {0.01, 0}, 1);
    add({52.5, 68 * t}, {0, 0.01}, 2);
    add({0, 68 * t}, {0, 0.01}, 3);
  }
  ASSERT_GT(sightings.size(), 100U);
  const Camera refined = refine(start.camera, points_of(truth, 3, noise), std::vector<char>(exact.size(), 1), sightings, false);
  EXPECT_LT(worst_px(refined, exact), worst_px(start.camera, exact));
  EXPECT_LT(worst_px(refined, exact), 3);
}

}  // namespace
}  // namespace marey::calibrate::pitch
