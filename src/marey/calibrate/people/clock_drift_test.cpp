#include "marey/calibrate/people/clock_drift.h"

#include <gtest/gtest.h>

namespace marey::calibrate::people {
namespace {

/// Two cameras see points that move at 300 px/s for ten minutes; the second one's times are late by offset + drift t.
struct Observed {
  bundle::Bundle bundle;
  bundle::BundleResult fitted;
  std::vector<double> times_s;

  Observed(double offset_s, double drift, double speed) {
    for (int c = 0; c < 2; ++c) {
      bundle::BundleCamera& camera = bundle.cameras.emplace_back();
      camera.lens = geometry::BrownLens{.focal = {1000, 1000}, .principal = {640, 512}};
      camera.camera_from_world.translation = Vector<3>(c, 0, 0);
      camera.refine_offset = c == 1;
    }
    for (int i = 0; i < 200; ++i) {
      times_s.push_back(3.0 * i);
      bundle.bodies.emplace_back(Vector<3>(0.1 * (i % 7), 0.1 * (i % 5), 5));
      for (int c = 0; c < 2; ++c) {
        bundle::BundleObservation one{.camera = c, .body = i, .velocity = speed * Vector<2>(1, 0.2 * (i % 3))};
        one.pixel = *predicted_pixel(bundle, one);
        if (c == 1) one.pixel += one.velocity * (offset_s + drift * times_s.back());
        bundle.observations.push_back(one);
        fitted.inlier.push_back(1);
      }
    }
    fitted.noise_px = 1;
  }
};

ClockCorrection second_camera(const Observed& seen) {
  return clock_corrections(seen.bundle, seen.fitted, seen.times_s, {0, 0})[1];
}

TEST(ClockDrift, IsFoundByWhatMovesInTheImage) {
  const ClockCorrection found = second_camera(Observed(0.004, 30e-6, 300));
  EXPECT_NEAR(found.drift, 30e-6, 1e-6);
  EXPECT_NEAR(found.offset_s, 0.004, 0.0005);
  EXPECT_LT(found.deviation, 10e-6);
}

TEST(ClockDrift, IsFoundInOneStepWherePointsLieBetweenTheViews) {
  Observed seen(0.004, 30e-6, 300);
  for (std::size_t i = 1; i < seen.bundle.observations.size(); i += 2) {  // as an adjustment leaves them: half of the error each
    const bundle::BundleObservation& late = seen.bundle.observations[i];
    const double depth = 5, focal = 1000;
    const Vector<2> half = (late.pixel - *predicted_pixel(seen.bundle, late)) / 2;
    auto& place = std::get<Vector<3>>(seen.bundle.bodies[static_cast<std::size_t>(late.body)]);
    place.head<2>() += half * depth / focal;
  }
  const ClockCorrection found = second_camera(seen);
  EXPECT_NEAR(found.drift, 30e-6, 1e-6);
  EXPECT_NEAR(found.offset_s, 0.004, 0.0005);
}

TEST(ClockDrift, OfACameraWhoseOffsetIsKnownIsNotTouched) {
  Observed seen(0.004, 30e-6, 300);
  seen.bundle.cameras[1].refine_offset = false;
  EXPECT_EQ(second_camera(seen).drift, 0);
  EXPECT_EQ(second_camera(seen).offset_s, 0);
}

TEST(ClockDrift, IsNoneWhereNothingMoves) {
  const ClockCorrection found = second_camera(Observed(0, 30e-6, 0));
  EXPECT_EQ(found.drift, 0);
  EXPECT_EQ(found.offset_s, 0);
}

TEST(ClockDrift, LeavesOutOutliers) {
  Observed seen(0, 20e-6, 300);
  for (std::size_t i = 1; i < seen.bundle.observations.size(); i += 10) {
    seen.bundle.observations[i].pixel += Vector<2>(500, 0);
    seen.fitted.inlier[i] = 0;
  }
  EXPECT_NEAR(second_camera(seen).drift, 20e-6, 1e-6);
}

}  // namespace
}  // namespace marey::calibrate::people
