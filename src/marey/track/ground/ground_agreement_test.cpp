#include "marey/track/ground/ground_agreement.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground {
namespace {

/// What camera `camera` is wrong at a place, m.
Vector<2> error_of(int camera, const Vector<2>& place) {
  const double u = place.x() / 50 - 1, v = place.y() / 30 - 1;
  return camera == 0 ? Vector<2>(0.5 * u, 0.4) : camera == 1 ? Vector<2>(-0.4, 0.5 * v) : Vector<2>(0.3 * v, -0.4 * u);
}

/// Instants of 25 people all over a pitch, seen by three cameras with `noise` m; in `share` of its errors each camera is wrong.
std::vector<GroundInstant> scene(std::uint64_t seed, double share, double noise) {
  ground_scene::Random random(seed);
  std::vector<GroundInstant> instants;
  for (int k = 0; k < 200; ++k) {
    std::vector<std::vector<Observation<2>>> seen(3);
    for (int i = 0; i < 25; ++i) {
      const Vector<2> place(random.uniform(0, 100), random.uniform(0, 60));
      for (int camera = 0; camera < 3; ++camera) {
        if (random.chance(0.2)) continue;
        Observation<2>& one = seen[static_cast<std::size_t>(camera)].emplace_back();
        one.camera = CameraId{camera};
        one.value = place + share * error_of(camera, place) + random.gaussian(noise);
        one.covariance = 0.01 * Matrix<2>::Identity();
      }
    }
    std::vector<CameraObservations> views;
    for (int camera = 0; camera < 3; ++camera) views.push_back({CameraId{camera}, {}, seen[static_cast<std::size_t>(camera)]});
    instants.emplace_back(k, timestamp_from_seconds(k / 2.0), views);
  }
  return instants;
}

/// Root mean square of what cameras still disagree by over the pitch, m.
double disagreement(const GroundAgreement& agreement, double share) {
  double sum = 0;
  int count = 0;
  for (double x = 5; x < 100; x += 10) {
    for (double y = 5; y < 60; y += 10) {
      Vector<2> places[3];
      for (int camera = 0; camera < 3; ++camera) {
        Observation<2> one;
        one.camera = CameraId{camera};
        one.value = Vector<2>(x, y) + share * error_of(camera, {x, y});
        places[camera] = agreement.corrected(one).value;
      }
      for (int camera = 0; camera < 3; ++camera, ++count) sum += (places[camera] - places[(camera + 1) % 3]).squaredNorm();
    }
  }
  return std::sqrt(sum / count);
}

TEST(GroundAgreement, SmoothErrorsOfCamerasAreLearned) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const GroundAgreement agreement = GroundAgreement::learn(scene(seed, 1, 0.1), 3);
    ASSERT_TRUE(agreement.learned()) << "seed " << seed;
    EXPECT_GT(disagreement({}, 1), 0.6);
    EXPECT_LT(disagreement(agreement, 1), 0.25) << "seed " << seed;
  }
}

TEST(GroundAgreement, CamerasThatAgreeAreLeftAlone) {
  const GroundAgreement agreement = GroundAgreement::learn(scene(4, 0, 0.1), 3);
  EXPECT_LT(disagreement(agreement, 0), 0.05);
}

TEST(GroundAgreement, NoiseIsMeasured) {
  const GroundAgreement agreement = GroundAgreement::learn(scene(5, 0, 0.2), 3);
  Observation<2> one;
  one.value = {50, 30};
  one.covariance = 0.01 * Matrix<2>::Identity();
  EXPECT_NEAR(std::sqrt(agreement.corrected(one).covariance(0, 0)), 0.2, 0.03);
}

TEST(GroundAgreement, OneCameraHasNobodyToAgreeWith) {
  EXPECT_FALSE(GroundAgreement::learn(scene(6, 1, 0.1), 1).learned());
  EXPECT_FALSE(GroundAgreement::learn({}, 3).learned());
}

}  // namespace
}  // namespace marey::track::ground
