#include "marey/reconstruct/camera_watch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/reconstruct/room_test.h"

namespace marey::reconstruct {
namespace {

constexpr double kNoise = 0.1;  // px

/// What the cameras see of points, a tenth of it missed.
std::vector<Observation<2>> observed_by(const std::vector<Camera>& cameras, const std::vector<Vector<3>>& points, int covered,
                                        room::Random& random) {
  std::vector<Observation<2>> detected;
  for (int c = 0; c < std::ssize(cameras); ++c) {
    for (const Vector<3>& point : points) {
      const auto pixel = cameras[static_cast<std::size_t>(c)].project(point);
      if (!pixel || c == covered || random.chance(0.1)) continue;
      Observation<2> blob;
      blob.value = *pixel + random.gaussian_2d(kNoise);
      blob.covariance.reset();
      blob.camera = CameraId{c};
      detected.push_back(blob);
    }
  }
  return detected;
}

std::vector<Vector<3>> swarm_at(int frame, const std::vector<Vector<3>>& middles) {
  std::vector<Vector<3>> points;
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const double phase = 0.02 * frame + static_cast<double>(i);
    points.push_back(middles[i] + 0.2 * Vector<3>(std::sin(phase), std::cos(1.3 * phase), std::sin(0.7 * phase)));
  }
  return points;
}

struct Watching {
  std::vector<Camera> cameras = room::cameras_round(5);
  std::vector<Vector<3>> middles;
  room::Random random;
  CameraWatch watch;

  explicit Watching(std::uint64_t seed)
      : random(seed), watch(cameras, {CameraId{0}, CameraId{1}, CameraId{2}, CameraId{3}, CameraId{4}}) {
    for (int i = 0; i < 20; ++i) middles.push_back(random.in_room());
  }

  /// Frames of a rig of which some camera may be covered; what the watch says.
  std::optional<MovedCamera> observe_frame(int first, int last, const std::vector<Camera>& rig, int covered = -1) {
    CorrespondOptions options;
    options.noise_px = kNoise;
    Corresponder corresponder(watch.cameras(), options);
    for (int frame = first; frame < last; ++frame) {
      const auto detected = observed_by(rig, swarm_at(frame, middles), covered, random);
      if (auto moved = watch.observe_frame(timestamp_from_seconds(0.01 * frame), detected, corresponder.match(detected), kNoise))
        return moved;
    }
    return std::nullopt;
  }
};

TEST(CameraWatch, FindsWhichCameraWasMovedWhenAndWhereTo) {
  for (const double angle : {0.003, 0.01, 0.04}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(fmt::format("turned by {} rad, seed {}", angle, seed));
      Watching scene(seed);
      EXPECT_FALSE(scene.observe_frame(0, 60, scene.cameras));
      std::vector<Camera> after = scene.cameras;
      const Vector<3> about = Vector<3>(scene.random.uniform(-1, 1), scene.random.uniform(-1, 1), 0.5).normalized();
      const Rigid3 push{geometry::rotation_from(angle * about), angle * Vector<3>(0.5, -0.5, 0.7)};
      after[2] = Camera(after[2].lens(), push * after[2].camera_from_world(), after[2].size());
      const auto moved = scene.observe_frame(60, 120, after);
      ASSERT_TRUE(moved);
      EXPECT_EQ(moved->camera, CameraId{2});
      EXPECT_NEAR(seconds(moved->since), 0.6, 0.03);
      EXPECT_NEAR(moved->angle, angle, 5e-4);
      EXPECT_LT(moved->rms_px, 3 * kNoise);
      const Camera& found = scene.watch.cameras()[2];
      EXPECT_LT((found.centre() - after[2].centre()).norm(), 0.002);
      for (const Vector<3>& point : swarm_at(200, scene.middles)) {
        EXPECT_LT((*found.project(point) - *after[2].project(point)).norm(), 0.25);
      }
      EXPECT_FALSE(scene.observe_frame(120, 180, after)) << "it is said once";
    }
  }
}

TEST(CameraWatch, ACoveredCameraWasNotMoved) {
  Watching scene(4);
  EXPECT_FALSE(scene.observe_frame(0, 60, scene.cameras));
  EXPECT_FALSE(scene.observe_frame(60, 160, scene.cameras, 2));
}

}  // namespace
}  // namespace marey::reconstruct
