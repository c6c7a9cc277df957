#include "marey/track/image/camera_motion.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::track::image {
namespace {

constexpr double kStep = 0.04;   // s
constexpr double kNoise = 0.03;  // of a person's height

/// People who stand in the scene, and the observations of them through `view_from_scene`.
class Stand {
 public:
  Stand(int people, unsigned seed) : random_(seed) {
    std::uniform_real_distribution<double> x(100, 1180), y(200, 600), size(60, 140);
    for (int i = 0; i < people; ++i) people_.push_back({{x(random_), y(random_)}, size(random_)});
  }

  void show(CameraMotion& camera, const geometry::Similarity2& view_from_scene, int untrusted = 0) {
    camera.predict(kStep);
    std::vector<Sighting> expected, detected;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> x(0, 1280), y(0, 720);
    for (const Sighting& person : people_) {
      const double noise = kNoise * person.size;
      expected.push_back(
          {camera.view_from_scene() * person.location, camera.view_from_scene().scale() * person.size, 2 * noise * noise});
      const Vector<2> off(noise * normal(random_), noise * normal(random_));
      detected.push_back({view_from_scene * person.location + off, view_from_scene.scale() * person.size});
    }
    for (int i = 0; i < untrusted; ++i) detected.push_back({{x(random_), y(random_)}, 90});
    camera.correct(expected, detected);
  }

  /// How far the camera is off for the worst of them, px.
  double error(const CameraMotion& camera, const geometry::Similarity2& view_from_scene) const {
    double maximum = 0;
    for (const Sighting& person : people_)
      maximum = std::max(maximum, (camera.view_from_scene() * person.location - view_from_scene * person.location).norm());
    return maximum;
  }

 private:
  std::mt19937 random_;
  std::vector<Sighting> people_;
};

TEST(CameraMotion, FollowsAPanThatBeginsSlowly) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Stand stand(10, seed);
    CameraMotion camera;
    geometry::Similarity2 truth;
    for (int frame = 0; frame < 150; ++frame) {
      truth.shift += Vector<2>(std::min(6.0, 0.05 * frame), 1);  // px
      stand.show(camera, truth, 3);
    }
    EXPECT_LT(stand.error(camera, truth), 12) << "seed " << seed << ": of 700 px";
  }
}

TEST(CameraMotion, ExpectsAPanToGoOn) {
  Stand stand(10, 1);
  CameraMotion camera;
  geometry::Similarity2 truth;
  for (int frame = 0; frame < 100; ++frame) {
    truth.shift.x() += 5;
    stand.show(camera, truth);
  }
  const Vector<2> middle(640, 400), now = camera.view_from_scene() * middle;
  EXPECT_EQ(camera.view_from_scene(0) * middle, now);
  const Vector<2> ahead = camera.view_from_scene(5 * kStep) * middle - now;
  EXPECT_NEAR(ahead.x(), 25, 6) << "px, in five frames";
  EXPECT_NEAR(ahead.y(), 0, 6);
}

/// A few people who run apart look like a zoom: it is trusted with caution, and the rest the people's own filters follow.
TEST(CameraMotion, BelievesZoomWithCaution) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Stand zoomed(12, seed), still(12, seed);
    CameraMotion camera, standing;
    geometry::Similarity2 truth;
    for (int frame = 0; frame < 100; ++frame) {
      truth = geometry::Similarity2::about({640, 360}, 1.004, 0, {0, 0}) * truth;
      zoomed.show(camera, truth, 2);
      still.show(standing, {}, 2);
    }
    EXPECT_GT(camera.view_from_scene().scale(), 1.02) << "seed " << seed << ": of 1.49";
    EXPECT_LT(camera.view_from_scene().scale(), 1.5) << "seed " << seed;
    EXPECT_NEAR(standing.view_from_scene().scale(), 1, 0.01) << "seed " << seed;
  }
}

TEST(CameraMotion, FollowsAJolt) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Stand stand(10, seed);
    CameraMotion camera;
    geometry::Similarity2 truth;
    for (int frame = 0; frame < 60; ++frame) {
      if (frame == 50) truth.shift += Vector<2>(25, -15);
      stand.show(camera, truth);
    }
    EXPECT_LT(stand.error(camera, truth), 8) << "seed " << seed;
  }
}

TEST(CameraMotion, LeavesACameraWhereItStands) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Stand stand(10, seed);
    CameraMotion camera;
    for (int frame = 0; frame < 500; ++frame) stand.show(camera, {}, 3);
    EXPECT_LT(stand.error(camera, {}), 8) << "seed " << seed << ": after 20 s";
  }
}

TEST(CameraMotion, NeedsThreePeople) {
  CameraMotion camera;
  const std::vector<Sighting> expected = {{{100, 100}, 80, 4}, {{300, 100}, 80, 4}};
  const std::vector<Sighting> detected = {{{120, 100}, 80}, {{320, 100}, 80}};
  camera.predict(kStep);
  camera.correct(expected, detected);
  EXPECT_EQ(camera.view_from_scene().shift, Vector<2>(0, 0));
  camera.correct({}, {});
  EXPECT_EQ(camera.view_from_scene().turn, (Matrix<2>::Identity()));
}

}  // namespace
}  // namespace marey::track::image
