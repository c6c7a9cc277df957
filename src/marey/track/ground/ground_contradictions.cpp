#include "marey/track/ground/ground_contradictions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace marey::track::ground {
namespace {

constexpr std::size_t kMostCompared = 200;  // instants, evenly over the recording
constexpr double kMeeting = 1;              // m
constexpr double kWatchedCell = 3;          // m, of the ground that a camera is known to see
constexpr int kWatched = 3;                 // people in it, over all instants: so many are not false alarms
constexpr int kFewestLooks = 100;           // of people of the one where the other looks
constexpr double kFewestFree = 0.3;         // of them must be where nobody of another time was, or chance tells nothing
constexpr double kBriefest = 4;             // s of a recording: in half of it people have gone elsewhere

using Places = std::vector<Vector<2>>;
using Cell = std::pair<int, int>;

Cell cell_of(const Vector<2>& place) {
  return {static_cast<int>(std::floor(place.x() / kWatchedCell)), static_cast<int>(std::floor(place.y() / kWatchedCell))};
}

/// What one camera saw, instant by instant.
struct Watcher {
  std::vector<Places> seen;
  std::set<Cell> watched;
};

std::vector<Watcher> watchers(std::span<const GroundInstant> instants, const GroundAgreement& agreement, int cameras) {
  std::vector<Watcher> all(static_cast<std::size_t>(cameras));
  std::vector<std::map<Cell, int>> counts(all.size());
  const std::size_t step = std::max<std::size_t>(1, instants.size() / kMostCompared);
  for (std::size_t k = 0; k < instants.size(); k += step) {
    for (Watcher& watcher : all) watcher.seen.emplace_back();
    for (const CameraObservations& view : instants[k].cameras) {
      const auto camera = static_cast<std::size_t>(number(view.camera));
      for (const Observation<2>& one : view.seen) {
        if (one.shared) continue;
        all[camera].seen.back().push_back(agreement.corrected(one).value);
        ++counts[camera][cell_of(all[camera].seen.back().back())];
      }
    }
  }
  for (std::size_t camera = 0; camera < all.size(); ++camera) {
    for (const auto& [cell, count] : counts[camera]) {
      if (count >= kWatched) all[camera].watched.insert(cell);
    }
  }
  return all;
}

bool holds(const Places& places, const Vector<2>& place) {
  return std::any_of(places.begin(), places.end(), [&](const Vector<2>& one) { return (one - place).norm() <= kMeeting; });
}

/// How often people of the one stand where the other looks, sees somebody, and would have half of the recording later.
struct Looks {
  int all = 0, now = 0, then = 0;

  void add(const Watcher& of, const Watcher& by) {
    const std::size_t count = of.seen.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (const Vector<2>& place : of.seen[k]) {
        if (!by.watched.contains(cell_of(place))) continue;
        ++all;
        now += holds(by.seen[k], place) ? 1 : 0;
        then += holds(by.seen[(k + count / 2) % count], place) ? 1 : 0;
      }
    }
  }
};

}  // namespace

std::vector<ComparedCameras> compare_cameras(std::span<const GroundInstant> instants, const GroundAgreement& agreement,
                                             int cameras) {
  std::vector<ComparedCameras> compared;
  if (cameras < 2 || instants.empty() || seconds(instants.back().time - instants.front().time) < kBriefest) return compared;
  const std::vector<Watcher> all = watchers(instants, agreement, cameras);
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      Looks looks;
      looks.add(all[a], all[b]);
      looks.add(all[b], all[a]);
      const int free = looks.all - looks.then;
      if (looks.all < kFewestLooks || free < kFewestFree * looks.all) continue;
      compared.push_back({CameraId{static_cast<int>(a)}, CameraId{static_cast<int>(b)},
                          std::max(0.0, static_cast<double>(looks.now - looks.then) / free)});
    }
  }
  return compared;
}

}  // namespace marey::track::ground
