#include "marey/pipeline/people/camera_span.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::pipeline::people {
namespace {

/// Ten people who walk somewhere else every two seconds, for 20 s, before a camera that pans to and fro by `pan` px.
CameraSpan watched(double pan, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> speed(0, 40);
  std::vector<Vector<2>> locations(10, Vector<2>(300, 300)), velocities(10);
  CameraSpan span;
  for (int frame = 0; frame < 500; ++frame) {
    const double time = frame / 25.0;
    std::vector<Track<2>> tracks;
    for (std::size_t i = 0; i < locations.size(); ++i) {
      if (frame % 50 == 0) velocities[i] = {speed(random), speed(random)};
      locations[i] += velocities[i] / 25;
      Track<2> track;
      track.id = TrackId{static_cast<int>(i) + 1};
      track.confirmed = true;
      track.position = locations[i] + Vector<2>(pan * std::sin(time), 0);
      track.box = Box::from_centre(track.position, 40, 100);
      tracks.push_back(track);
    }
    span.observe_frame(timestamp_from_seconds(time), tracks);
  }
  return span;
}

TEST(CameraSpan, KnowsACameraThatPansFromOneThatStands) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(watched(150, seed).moved()) << "seed " << seed;
    EXPECT_FALSE(watched(0, seed).moved()) << "seed " << seed;
  }
  EXPECT_FALSE(CameraSpan().moved());
}

}  // namespace
}  // namespace marey::pipeline::people
