#include "marey/calibrate/ptz/tripod_spread.h"

#include <gtest/gtest.h>

namespace marey::calibrate::ptz {
namespace {

const cv::Size kSpreadSize(1280, 720);
const geometry::Tripod kSpreadTripod{{50, -24, 13}, {}, 0, 0.2, 0.01};

/// Exact paint of every line in view.
std::vector<PaintSighting> exact_paint(const geometry::Heading& heading) {
  const Camera camera = geometry::camera_of(kSpreadTripod, heading, kSpreadSize);
  std::vector<PaintSighting> paint;
  const auto lines = geometry::pitch_lines({}, 2);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (std::size_t i = 0; i < lines[line].points.size(); ++i) {
      const Vector<2>& at = lines[line].points[i];
      const auto detected = camera.project_with_jacobian({at.x(), at.y(), 0});
      if (!detected || !camera.in_image(detected->pixel)) continue;
      const Vector<2> along = (detected->by_world.leftCols<2>() * lines[line].tangents[i]).normalized(),
                      normal(-along.y(), along.x());
      paint.push_back(
          {at.cast<float>(), detected->pixel.cast<float>(), normal.cast<float>(), 0.5F, static_cast<std::int16_t>(line)});
    }
  }
  return paint;
}

TEST(TripodSpread, ATripodAsideTurnsThePanMoreThanThePlaces) {
  std::vector<TurnRecord> records(3);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const geometry::Heading heading{0.3, 0.21, 0.9};
    records[i].time_s = 0.04 * static_cast<double>(i);
    if (i > 0) records[i].rotated = Rotated{Vector<3>::Zero(), heading.log_focal, 100, 100};
    records[i].found = Aim{heading, 1e-6 * Matrix<3>::Identity()};
    records[i].paint = exact_paint(heading);
  }
  const SmoothOptions options;
  const auto smooth = smooth_ptz(records, kSpreadTripod, kSpreadSize, options);
  Matrix<8> covariance = Matrix<8>::Zero();
  covariance(0, 0) = 0.5 * 0.5;  // m², along the touchline
  const auto spread = spread_of_tripod(records, smooth, kSpreadTripod, covariance, kSpreadSize, options);
  geometry::Tripod aside = kSpreadTripod;
  aside.location.x() += 0.5;
  SmoothOptions loose = options;
  loose.aim.cut_off *= 12;
  const auto moved = smooth_ptz(records, aside, kSpreadSize, loose);
  const double turned = moved[1]->heading.pan - smooth[1]->heading.pan;
  EXPECT_GT(std::abs(turned), 0.003);
  EXPECT_NEAR(std::sqrt(spread[1].heading(0, 0)), std::abs(turned), 0.1 * std::abs(turned));
  EXPECT_LT(std::sqrt(spread[1].location(0, 0)), 0.6 * std::abs(turned));
  EXPECT_GT(std::sqrt(spread[1].location(0, 0)), 1e-6);
}

TEST(TripodSpread, AnExactTripodAddsNothing) {
  std::vector<TurnRecord> records(1);
  records[0].found = Aim{{0.3, 0.21, 0.9}, 1e-6 * Matrix<3>::Identity()};
  records[0].paint = exact_paint(records[0].found->heading);
  const auto smooth = smooth_ptz(records, kSpreadTripod, kSpreadSize, {});
  const auto spread = spread_of_tripod(records, smooth, kSpreadTripod, Matrix<8>::Zero(), kSpreadSize, {});
  EXPECT_EQ(spread[0].heading.norm(), 0);
  EXPECT_EQ(spread[0].location.norm(), 0);
}

}  // namespace
}  // namespace marey::calibrate::ptz
