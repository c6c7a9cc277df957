#include "marey/pipeline/keypoints/tracked_people.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "marey/geometry/median.h"
#include "marey/reconstruct/keypoints/one_camera.h"
#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::pipeline::keypoints {
namespace {

namespace rk = reconstruct::keypoints;

void add_to_tracks(const rk::LocatedPerson& person, std::size_t instant, TrackedPeople& tracked) {
  rk::PersonTrack& track = tracked.tracks[person.id];
  if (track.instants.empty()) track = {.id = person.id, .first = instant, .instants = {}};
  track.instants.resize(instant - track.first + 1);
  track.instants.back() = person;
}

/// The first `most` instants.
TrackedPeople track_some(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set, double noise,
                         std::size_t maximum, const Hooks& hooks) {
  TrackedPeople tracked;
  rk::PeopleInViews people(set, static_cast<int>(cameras.size()));
  std::vector<rk::PersonView> views;
  for (std::size_t t = 0; t < std::min(maximum, frames.size()); ++t) {
    const auto begin = std::chrono::steady_clock::now();
    views.clear();
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const auto& detected = frames.at(t, c);
      for (std::size_t i = 0; i < detected.size(); ++i)
        views.push_back(rk::view_of(*cameras[c], static_cast<int>(c), static_cast<int>(i), detected[i], noise));
    }
    for (const rk::LocatedPerson& person : people.step(t == 0 ? 0 : 1 / frames.rate_hz(), views)) {
      add_to_tracks(person, t, tracked);
      for (const auto& point : person.points) {
        if (point) tracked.squares.push_back(point->chi_square / (2 * point->rays - 3));
      }
    }
    tracked.times_ms.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (maximum >= frames.size())
      hooks.advance(
          {.step = "placing", .done = static_cast<std::int64_t>(t) + 1, .total = static_cast<std::int64_t>(frames.size())});
  }
  tracked.detected = people.views_observed();
  tracked.located = people.views_located();
  return tracked;
}

}  // namespace

TrackedPeople track_in_views(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set, double noise,
                             const Hooks& hooks) {
  return track_some(cameras, frames, set, noise, frames.size(), hooks);
}

TrackedPeople track_on_floor(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set) {
  TrackedPeople tracked;
  const auto only = std::find_if(cameras.begin(), cameras.end(), [](const auto& camera) { return camera.has_value(); });
  const auto c = static_cast<std::size_t>(only - cameras.begin());
  rk::PeopleBeforeCamera people(set, **only, static_cast<int>(c), static_cast<int>(cameras.size()));
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const std::vector<Keypoints<2>>& detected = frames.at(t, c);
    tracked.detected += std::ssize(detected);
    for (const rk::LocatedPerson& person : people.step(t == 0 ? 0 : 1 / frames.rate_hz(), detected)) {
      ++tracked.located;
      add_to_tracks(person, t, tracked);
    }
  }
  return tracked;
}

double keypoint_noise(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set) {
  constexpr std::size_t kLearnsFrom = 300;  // instants, numerical: enough for a median
  constexpr double kMuchMore = 1.2;
  double best = 1, best_placed = 0;
  for (const double noise : {1.3, 2.6, 5.2}) {
    TrackedPeople tracked = track_some(cameras, frames, set, noise, std::min(kLearnsFrom, frames.size()), {});
    const double located = static_cast<double>(tracked.located);
    if (located <= kMuchMore * best_placed) continue;
    best_placed = located;
    // The median of a sum of squares is a little below its mean.
    best = noise * std::sqrt(geometry::median_or(tracked.squares, 0) / 0.9);
  }
  return std::clamp(best, 0.1, 10.0);
}

}  // namespace marey::pipeline::keypoints
