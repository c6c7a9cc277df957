#pragma once

// People who walk about a pitch and what cameras say of them, with known truth, for tests of ground trackers.

#include <functional>
#include <vector>

#include "marey/filter/random_stream.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground::ground_scene {

constexpr double rate = 25;  // Hz

class Random {
 public:
  explicit Random(std::uint64_t seed) : stream_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(); }
  bool chance(double probability) { return stream_.uniform() < probability; }
  Vector<2> gaussian(double sigma) {
    const auto [x, y] = stream_.normal_pair();
    return {sigma * x, sigma * y};
  }

 private:
  filter::RandomStream stream_;
};

/// A camera that sees the ground within a rectangle, 10 px a metre, its image's top at greater y. It is nearer to small y.
inline GroundView view_of(double left, double right, double bottom, double top) {
  Matrix<3> ground_from_image;
  ground_from_image << 0.1, 0, left, 0, -0.1, top, 0, 0, 1;
  return GroundView(ground_from_image, cv::Size(static_cast<int>((right - left) * 10), static_cast<int>((top - bottom) * 10)));
}

inline Observation<2> observed_at(const GroundView& view, int camera, const Vector<2>& location, double sigma = 0.15) {
  Observation<2> one;
  one.value = location;
  one.covariance = sigma * sigma * Matrix<2>::Identity();
  one.camera = CameraId{camera};
  one.score = 0.9;
  const Vector<2> foot = view.pixel(location).value();
  one.box = Box{foot.x() - 2, foot.y() + 0.5 - 18, 5, 18};
  return one;
}

/// One instant as each camera has it.
using Appearances = std::vector<std::vector<Observation<2>>>;

/// Runs `frames` instants; `see` fills each camera's look, `look` is handed the tracks.
inline void run(GroundTracker& tracker, int cameras, int frames, const std::function<void(int, Appearances&)>& observe_frame,
                const std::function<void(int, std::span<const Track<2>>)>& inspect) {
  for (int frame = 0; frame < frames; ++frame) {
    Appearances detected(static_cast<std::size_t>(cameras));
    observe_frame(frame, detected);
    const Timestamp now = timestamp_from_seconds(frame / rate);
    std::vector<CameraObservations> appearances;
    for (int i = 0; i < cameras; ++i) appearances.push_back({CameraId{i}, now, detected[static_cast<std::size_t>(i)]});
    inspect(frame, tracker.step(now, appearances));
  }
}

/// The confirmed track nearest to a place, or 0 where none lies within `radius`, m.
inline int id_at(std::span<const Track<2>> tracks, const Vector<2>& location, double radius = 1) {
  int id = 0;
  double nearest = radius;
  for (const Track<2>& track : tracks) {
    const double distance = (track.position - location).norm();
    if (!track.confirmed || distance > nearest) continue;
    nearest = distance;
    id = number(track.id);
  }
  return id;
}

inline int confirmed(std::span<const Track<2>> tracks) {
  int count = 0;
  for (const Track<2>& track : tracks) count += track.confirmed ? 1 : 0;
  return count;
}

}  // namespace marey::track::ground::ground_scene
