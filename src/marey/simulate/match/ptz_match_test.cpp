#include "marey/simulate/match/ptz_match.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/simulate/match/ptz_scenes.h"

namespace marey::simulate::match {
namespace {

PtzMatchOptions plain() {
  PtzMatchOptions options;
  options.size = {640, 360};
  options.people = options.scoreboard = false;
  options.noise = 0;
  options.degradation = {};
  options.exposure = 0;
  return options;
}

/// How far across the line, px, the paint's middle lies from where the camera sees the middle of the line; nothing if there is
/// no paint.
std::optional<double> paint_off(const cv::Mat& luma, const Camera& camera, const Vector<2>& location, const Vector<2>& tangent) {
  const auto detected = camera.project_with_jacobian({location.x(), location.y(), 0});
  if (!detected) return std::nullopt;
  const Vector<2> along = (detected->by_world.leftCols<2>() * tangent).normalized(), normal(-along.y(), along.x());
  if (detected->pixel.x() < 12 || detected->pixel.y() < 12 || detected->pixel.x() > luma.cols - 13 ||
      detected->pixel.y() > luma.rows - 13)
    return std::nullopt;
  double sum = 0, weighted = 0;
  for (double off = -4; off <= 4; off += 0.5) {
    const Vector<2> at = detected->pixel + off * normal;
    const cv::Mat spot = luma(cv::Rect(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())), 1, 1));
    const double bright = std::max(0, spot.at<std::uint8_t>(0, 0) - 125);
    sum += bright, weighted += bright * off;
  }
  if (sum < 40) return std::nullopt;
  return weighted / sum;
}

TEST(PtzMatch, PaintLiesWhereTheCameraSeesIt) {
  PtzMatch match(plain(), 3);
  for (int i = 0; i < 30; ++i) match.advance();
  const cv::Mat luma = match.image().luma();
  double sum = 0, count = 0;
  for (const geometry::PitchLine& line : geometry::pitch_lines({}, 1)) {
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const auto off = paint_off(luma, match.camera(), line.points[i], line.tangents[i]);
      if (off) sum += *off, ++count;
    }
  }
  ASSERT_GT(count, 30);
  EXPECT_LT(std::abs(sum / count), 0.15) << count;
}

TEST(PtzMatch, TheOperatorTurnsAndZoomsAndStandsStill) {
  PtzMatch match(plain(), 5);
  double least_pan = 9, most_pan = -9, least_focal = 9, most_focal = -9, fastest = 0;
  int still = 0;
  std::optional<geometry::Heading> last;
  for (int i = 0; i < 1500; ++i) {
    match.advance();
    const geometry::Heading now = *match.heading();
    least_pan = std::min(least_pan, now.pan), most_pan = std::max(most_pan, now.pan);
    least_focal = std::min(least_focal, now.log_focal), most_focal = std::max(most_focal, now.log_focal);
    if (last) {
      const double speed = std::abs(now.pan - last->pan) * 25 * 180 / M_PI;
      fastest = std::max(fastest, speed);
      still += speed < 0.3 ? 1 : 0;
    }
    last = now;
  }
  EXPECT_GT(most_pan - least_pan, 0.4);
  EXPECT_GT(most_focal - least_focal, 0.3);
  EXPECT_GT(fastest, 10);
  EXPECT_LT(fastest, 80);
  EXPECT_GT(still, 50);
}

TEST(PtzMatch, ACutShowsAnotherCamera) {
  PtzMatchOptions options = plain();
  options.cuts = {{0.04, 0.12}};
  PtzMatch match(options, 1);
  std::vector<bool> known;
  for (int i = 0; i < 5; ++i) {
    match.advance();
    known.push_back(match.heading().has_value());
  }
  EXPECT_EQ(known, (std::vector<bool>{true, false, false, true, true}));
}

TEST(PtzScenes, EachNameHasOneAndAWrongNameIsSaidWithAll) {
  for (const std::string_view name : ptz_scene_names()) EXPECT_NO_THROW(ptz_scene(name)) << name;
  try {
    ptz_scene("fog");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("whip"), std::string::npos);
  }
}

TEST(PtzScenes, PaleAndWornPaintIsLessBright) {
  const auto brightness = [](const PtzPaint& paint) {
    PtzMatchOptions options = plain();
    options.paint = paint;
    PtzMatch match(options, 3);
    match.advance();
    return cv::mean(match.image().luma())[0];
  };
  PtzPaint pale, worn, wet;
  pale.contrast = 0.3, worn.missing = 0.5, wet.wet = 1;
  EXPECT_LT(brightness(pale), brightness({}) - 0.1);
  EXPECT_LT(brightness(worn), brightness({}) - 0.05);
  EXPECT_GT(brightness(wet), brightness({}) + 1);
}

TEST(PtzScenes, AnOperatorWhoWhipsTurnsFaster) {
  const auto fastest = [](double whips) {
    PtzMatchOptions options = plain();
    options.operates.whips = whips;
    PtzMatch match(options, 5);
    double most = 0, last = 0;
    for (int i = 0; i < 500; ++i) {
      match.advance();
      if (i > 0) most = std::max(most, std::abs(match.heading()->pan - last));
      last = match.heading()->pan;
    }
    return most;
  };
  EXPECT_GT(fastest(0.5), 1.5 * fastest(0));
}

TEST(PtzMatch, TheSameSeedGivesTheSamePicture) {
  PtzMatchOptions options = plain();
  options.people = options.scoreboard = true, options.noise = 1;
  PtzMatch a(options, 2), b(options, 2);
  a.advance(), b.advance();
  EXPECT_EQ(cv::countNonZero(a.image().luma() != b.image().luma()), 0);
}

}  // namespace
}  // namespace marey::simulate::match
