#include "marey/reconstruct/time_alignment.h"

#include <gtest/gtest.h>

#include "marey/reconstruct/room_test.h"

namespace marey::reconstruct {
namespace {

constexpr double kAhead = 0.004;  // s from exposure to the instant

struct MovingScene {
  explicit MovingScene(std::uint64_t seed) : random(seed), camera(room::cameras_round(4)[1]) {
    for (int i = 0; i < 12; ++i) {
      Track<3> track;
      track.id = TrackId{i + 1};
      track.position = random.in_room();
      track.velocity = 3 * Vector<3>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      tracks.push_back(track);
    }
  }
  /// Where the markers are seen `ahead` before the instant.
  std::vector<Observation<2>> detected(double ahead) const {
    std::vector<Observation<2>> blobs;
    for (const Track<3>& track : tracks) blobs.emplace_back().value = *camera.project(track.position - ahead * track.velocity);
    return blobs;
  }
  double error(const std::vector<Observation<2>>& blobs) const {
    double worst = 0;
    for (std::size_t i = 0; i < blobs.size(); ++i)
      worst = std::max(worst, (blobs[i].value - *camera.project(tracks[i].position)).norm());
    return worst;
  }
  room::Random random;
  Camera camera;
  std::vector<Track<3>> tracks;
};

TEST(OwnTime, BlobsMoveAsTheMarkersThatAreExpected) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const MovingScene scene(seed);
    OwnTime own({scene.camera});
    for (const double ahead : {kAhead, -kAhead}) {
      auto blobs = scene.detected(ahead);
      EXPECT_GT(scene.error(blobs), 0.5);
      own.bring(CameraId{0}, timestamp_from_seconds(1 - ahead), timestamp_from_seconds(1), blobs, scene.tracks);
      EXPECT_LT(scene.error(blobs), 0.35) << "where two markers are seen side by side one may be taken for the other";
    }
  }
}

TEST(OwnTime, UsesBlobMotionWithoutPrediction) {
  const MovingScene scene(3);
  OwnTime own({scene.camera}, {.near_px = 12, .farthest_px = 40});
  const std::vector<Track<3>> one{scene.tracks.front()};
  const auto alone = [&](double ahead) {
    std::vector<Observation<2>> blob(1);
    blob[0].value = *scene.camera.project(one[0].position - ahead * one[0].velocity);
    return blob;
  };
  auto first = alone(kAhead + 0.01);
  own.bring(CameraId{0}, timestamp_from_seconds(1 - 0.01 - kAhead), timestamp_from_seconds(1 - 0.01), first, {});
  auto second = alone(kAhead);
  own.bring(CameraId{0}, timestamp_from_seconds(1 - kAhead), timestamp_from_seconds(1), second, {});
  EXPECT_NEAR((second[0].value - *scene.camera.project(one[0].position)).norm(), 0, 0.05);
}

TEST(OwnTime, InStepNothingChanges) {
  const MovingScene scene(5);
  OwnTime own({scene.camera});
  auto blobs = scene.detected(0.01);
  const auto before = blobs;
  own.bring(CameraId{0}, timestamp_from_seconds(1), timestamp_from_seconds(1), blobs, scene.tracks);
  for (std::size_t i = 0; i < blobs.size(); ++i) EXPECT_EQ(blobs[i].value, before[i].value);
}

}  // namespace
}  // namespace marey::reconstruct
