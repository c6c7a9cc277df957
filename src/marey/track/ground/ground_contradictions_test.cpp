#include "marey/track/ground/ground_contradictions.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground {
namespace {

/// Where camera `camera` has a person who stands at a place, m; nothing if it does not see it.
using LocatedBy = std::function<std::optional<Vector<2>>(int camera, const Vector<2>& location)>;

/// 20 s of 20 people who walk to and fro over 60 m × 40 m, seen by three cameras, two times a second.
std::vector<GroundInstant> walkers(std::uint64_t seed, const LocatedBy& located) {
  ground_scene::Random random(seed);
  std::vector<Vector<2>> from, to;
  for (int i = 0; i < 20; ++i) {
    from.emplace_back(random.uniform(0, 60), random.uniform(0, 40));
    to.emplace_back(random.uniform(0, 60), random.uniform(0, 40));
  }
  std::vector<GroundInstant> instants;
  for (int k = 0; k < 40; ++k) {
    std::vector<std::vector<Observation<2>>> detected(3);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Vector<2> location = from[i] + k / 39.0 * (to[i] - from[i]);
      for (int camera = 0; camera < 3; ++camera) {
        const auto at = located(camera, location);
        if (!at || random.chance(0.15)) continue;
        Observation<2>& one = detected[static_cast<std::size_t>(camera)].emplace_back();
        one.camera = CameraId{camera};
        one.value = *at + random.gaussian(0.2);
        one.covariance = 0.04 * Matrix<2>::Identity();
      }
    }
    std::vector<CameraObservations> views;
    for (int camera = 0; camera < 3; ++camera) views.push_back({CameraId{camera}, {}, detected[static_cast<std::size_t>(camera)]});
    instants.emplace_back(k, timestamp_from_seconds(k / 2.0), views);
  }
  return instants;
}

/// Pairs that contradict each other, as 10 · first + second.
std::vector<int> contradicting(const std::vector<GroundInstant>& instants) {
  std::vector<int> pairs;
  for (const ComparedCameras& one : compare_cameras(instants, CameraBias::learn(instants, 3), 3)) {
    if (one.contradict()) pairs.push_back(10 * number(one.first) + number(one.second));
  }
  return pairs;
}

TEST(GroundContradictions, CamerasThatAgreeDoNot) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto instants = walkers(seed, [](int, const Vector<2>& location) { return location; });
    EXPECT_EQ(compare_cameras(instants, {}, 3).size(), 3u);
    EXPECT_EQ(contradicting(instants), std::vector<int>()) << "seed " << seed;
  }
}

TEST(GroundContradictions, SmallErrorsAreNone) {
  const auto instants =
      walkers(6, [](int camera, const Vector<2>& location) { return Vector<2>(location + Vector<2>(0.3 * camera, 0.3)); });
  EXPECT_EQ(contradicting(instants), std::vector<int>());
}

TEST(GroundContradictions, AMirroredCameraIsFound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto instants = walkers(seed, [](int camera, const Vector<2>& location) {
      return camera == 1 ? Vector<2>(60 - location.x(), location.y()) : location;
    });
    EXPECT_EQ(contradicting(instants), (std::vector<int>{1, 12})) << "seed " << seed;
  }
}

TEST(GroundContradictions, ACameraThatIsOffByThreeMetresIsFound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto instants = walkers(seed, [](int camera, const Vector<2>& location) {
      return camera == 2 ? Vector<2>(location + Vector<2>(2.1, -2.2)) : location;
    });
    EXPECT_EQ(contradicting(instants), (std::vector<int>{2, 12})) << "seed " << seed;
  }
}

TEST(GroundContradictions, CamerasThatShareNoGroundAreNotCompared) {
  const auto instants = walkers(7, [](int camera, const Vector<2>& location) -> std::optional<Vector<2>> {
    if (location.x() < 21 * camera || location.x() > 21 * camera + 16) return std::nullopt;
    return location;
  });
  EXPECT_TRUE(compare_cameras(instants, {}, 3).empty());
  EXPECT_TRUE(compare_cameras({}, {}, 3).empty());
}

}  // namespace
}  // namespace marey::track::ground
