#include "marey/track/ground/camera_bias.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground {
namespace {

/// What camera `camera` is wrong at a place, m.
Vector<2> error_of(int camera, const Vector<2>& location) {
  const double u = location.x() / 50 - 1, v = location.y() / 30 - 1;
  return camera == 0 ? Vector<2>(0.5 * u, 0.4) : camera == 1 ? Vector<2>(-0.4, 0.5 * v) : Vector<2>(0.3 * v, -0.4 * u);
}

/// Instants of 25 people all over a pitch, seen by three cameras with `noise` m; in `share` of its errors each camera is wrong.
std::vector<GroundInstant> scene(std::uint64_t seed, double fraction, double noise) {
  ground_scene::Random random(seed);
  std::vector<GroundInstant> instants;
  for (int k = 0; k < 200; ++k) {
    std::vector<std::vector<Observation<2>>> detected(3);
    for (int i = 0; i < 25; ++i) {
      const Vector<2> location(random.uniform(0, 100), random.uniform(0, 60));
      for (int camera = 0; camera < 3; ++camera) {
        if (random.chance(0.2)) continue;
        Observation<2>& one = detected[static_cast<std::size_t>(camera)].emplace_back();
        one.camera = CameraId{camera};
        one.value = location + fraction * error_of(camera, location) + random.gaussian(noise);
        one.covariance = 0.01 * Matrix<2>::Identity();
      }
    }
    std::vector<CameraObservations> views;
    for (int camera = 0; camera < 3; ++camera) views.push_back({CameraId{camera}, {}, detected[static_cast<std::size_t>(camera)]});
    instants.emplace_back(k, timestamp_from_seconds(k / 2.0), views);
  }
  return instants;
}

/// Root mean square of what cameras still disagree by over the pitch, m.
double disagreement(const CameraBias& agreement, double fraction) {
  double sum = 0;
  int count = 0;
  for (double x = 5; x < 100; x += 10) {
    for (double y = 5; y < 60; y += 10) {
      Vector<2> locations[3];
      for (int camera = 0; camera < 3; ++camera) {
        Observation<2> one;
        one.camera = CameraId{camera};
        one.value = Vector<2>(x, y) + fraction * error_of(camera, {x, y});
        locations[camera] = agreement.corrected(one).value;
      }
      for (int camera = 0; camera < 3; ++camera, ++count) sum += (locations[camera] - locations[(camera + 1) % 3]).squaredNorm();
    }
  }
  return std::sqrt(sum / count);
}

TEST(CameraBias, SmoothErrorsOfCamerasAreLearned) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const CameraBias agreement = CameraBias::learn(scene(seed, 1, 0.1), 3);
    ASSERT_TRUE(agreement.learned()) << "seed " << seed;
    EXPECT_GT(disagreement({}, 1), 0.6);
    EXPECT_LT(disagreement(agreement, 1), 0.25) << "seed " << seed;
  }
}

TEST(CameraBias, CamerasThatAgreeAreLeftAlone) {
  const CameraBias agreement = CameraBias::learn(scene(4, 0, 0.1), 3);
  EXPECT_LT(disagreement(agreement, 0), 0.05);
}

struct Errors {
  double noise = 0.1;       // m, of each frame
  double lasting = 0;       // m, per person and camera
  double constant_s = 0.5;  // s, of which
  double along = 1;         // √ of twice the share of that in x: 1, in both axes alike
  double stated = 0.1;      // m
};

/// 60 s of 25 people who walk over a pitch, seen by three cameras at 25 Hz, with errors of each camera that last for a while. A
/// false observation in ten.
std::vector<GroundInstant> walked(std::uint64_t seed, const Errors& errors) {
  ground_scene::Random random(seed);
  std::vector<Vector<2>> location, velocity;
  std::vector<std::vector<Vector<2>>> error(3);
  for (int i = 0; i < 25; ++i) {
    location.emplace_back(random.uniform(0, 100), random.uniform(0, 60));
    velocity.push_back(random.gaussian(2));
    for (auto& of : error) of.push_back(random.gaussian(errors.lasting));
  }
  const double dt = 1 / ground_scene::rate, kept = std::exp(-dt / errors.constant_s);
  const Vector<2> by_axis(errors.along, std::sqrt(std::max(0.0, 2 - errors.along * errors.along)));
  std::vector<GroundInstant> instants;
  for (int k = 0; k < 1500; ++k) {
    std::vector<std::vector<Observation<2>>> detected(3);
    for (std::size_t i = 0; i < location.size(); ++i) {
      location[i] += dt * velocity[i];
      for (int axis = 0; axis < 2; ++axis) {
        if (location[i][axis] < 0 || location[i][axis] > (axis == 0 ? 100 : 60)) velocity[i][axis] *= -1;
      }
      for (int camera = 0; camera < 3; ++camera) {
        Vector<2>& own = error[static_cast<std::size_t>(camera)][i];
        own = kept * own + random.gaussian(errors.lasting * std::sqrt(1 - kept * kept));
        if (random.chance(0.1)) continue;
        Observation<2>& one = detected[static_cast<std::size_t>(camera)].emplace_back();
        one.camera = CameraId{camera};
        one.value = location[i] + own.cwiseProduct(by_axis) + random.gaussian(errors.noise);
        if (random.chance(0.1)) one.value = {random.uniform(0, 100), random.uniform(0, 60)};
        one.covariance = errors.stated * errors.stated * Matrix<2>::Identity();
        (*one.covariance)(0, 0) *= errors.along > 1 ? 4 : 1;
      }
    }
    std::vector<CameraObservations> views;
    for (int camera = 0; camera < 3; ++camera) views.push_back({CameraId{camera}, {}, detected[static_cast<std::size_t>(camera)]});
    instants.emplace_back(k, timestamp_from_seconds(k * dt), views);
  }
  return instants;
}

/// The remainder of an error's standard deviation a tenth of a second later, m.
double what_lasts(const Errors& errors) {
  return errors.lasting * std::exp(-0.1 / errors.constant_s / 2);
}

TEST(CameraBias, MeasuresLastingError) {
  std::uint64_t seed = 10;
  for (const Errors& errors : {Errors{.lasting = 0.2}, Errors{.noise = 0.3, .lasting = 0.2, .stated = 0.3},
                               Errors{.lasting = 0.25, .stated = 0.4}, Errors{.lasting = 0.2, .along = std::sqrt(2.0)},
                               Errors{.noise = 0.2, .lasting = 0.1, .stated = 0.2}, Errors{.noise = 0.1, .lasting = 0.35}}) {
    const CameraBias agreement = CameraBias::learn(walked(++seed, errors), 3);
    ASSERT_TRUE(agreement.disagreement());
    EXPECT_NEAR(*agreement.disagreement() / what_lasts(errors), 1, 0.12)
        << "noise " << errors.noise << " lasting " << errors.lasting << " stated " << errors.stated << " along " << errors.along;
  }
}

TEST(CameraBias, FindsLittleLastingErrorInWhiteNoise) {
  EXPECT_LT(CameraBias::learn(walked(20, {.noise = 0.2, .stated = 0.2}), 3).disagreement().value(), 0.08);
}

double noise_factor(const CameraBias& agreement) {
  Observation<2> one;
  one.value = {50, 30};
  one.covariance = Matrix<2>::Identity();
  return std::sqrt(agreement.corrected(one).covariance.value()(0, 0));
}

TEST(CameraBias, NoiseIsMeasuredApartFromWhatLasts) {
  EXPECT_NEAR(noise_factor(CameraBias::learn(walked(5, {.noise = 0.2, .lasting = 0.2, .constant_s = 5}), 3)), 2, 0.25);
}

TEST(CameraBias, StatedNoiseIsLowerBound) {
  EXPECT_EQ(noise_factor(CameraBias::learn(walked(6, {.noise = 0.1, .stated = 0.3}), 3)), 1);
}

TEST(CameraBias, WithoutTheSamePeopleTwiceAShareIsTakenToLast) {
  const CameraBias agreement = CameraBias::learn(scene(7, 0, 0.2), 3);
  EXPECT_NEAR(noise_factor(agreement), 2, 0.3);
  EXPECT_NEAR(agreement.disagreement().value(), 0.085, 0.01);
}

TEST(CameraBias, SingleCameraHasNoAgreement) {
  EXPECT_FALSE(CameraBias::learn(scene(6, 1, 0.1), 1).learned());
  EXPECT_FALSE(CameraBias::learn({}, 3).learned());
}

}  // namespace
}  // namespace marey::track::ground
