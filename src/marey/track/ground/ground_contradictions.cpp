#include "marey/track/ground/ground_contradictions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace marey::track::ground {
namespace {

constexpr std::size_t kMaxCompared = 200;  // instants, evenly over the recording
constexpr double kEncounter = 1;           // m
constexpr double kWatchedCell = 3;         // m, of the ground that a camera is known to see
constexpr int kWatched = 3;                // people in it, over all instants: this many are not false alarms
constexpr int kMinAppearance = 100;        // of people of the one within the other's view
constexpr double kMinFreeCount = 0.3;      // of them must be where no person of another time was, or chance shows nothing
constexpr double kBriefest = 4;            // s of a recording: in half of it people have gone elsewhere

using Locations = std::vector<Vector<2>>;
using Cell = std::pair<int, int>;

Cell cell_of(const Vector<2>& location) {
  return {static_cast<int>(std::floor(location.x() / kWatchedCell)), static_cast<int>(std::floor(location.y() / kWatchedCell))};
}

/// What one camera saw, instant by instant.
struct Watcher {
  std::vector<Locations> detected;
  std::set<Cell> watched;
};

std::vector<Watcher> watchers(std::span<const GroundInstant> instants, const CameraBias& agreement, int cameras) {
  std::vector<Watcher> all(static_cast<std::size_t>(cameras));
  std::vector<std::map<Cell, int>> counts(all.size());
  const std::size_t step = std::max<std::size_t>(1, instants.size() / kMaxCompared);
  for (std::size_t k = 0; k < instants.size(); k += step) {
    for (Watcher& watcher : all) watcher.detected.emplace_back();
    for (const CameraObservations& view : instants[k].cameras) {
      const auto camera = static_cast<std::size_t>(number(view.camera));
      for (const Observation<2>& one : view.detected) {
        if (one.shared) continue;
        all[camera].detected.back().push_back(agreement.corrected(one).value);
        ++counts[camera][cell_of(all[camera].detected.back().back())];
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

bool holds(const Locations& locations, const Vector<2>& location) {
  return std::any_of(locations.begin(), locations.end(),
                     [&](const Vector<2>& one) { return (one - location).norm() <= kEncounter; });
}

/// How often people of the one stand where the other watches, sees a person, and would have half of the recording later.
struct Appearances {
  int all = 0, now = 0, then = 0;

  void add(const Watcher& of, const Watcher& by) {
    const std::size_t count = of.detected.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (const Vector<2>& location : of.detected[k]) {
        if (!by.watched.contains(cell_of(location))) continue;
        ++all;
        now += holds(by.detected[k], location) ? 1 : 0;
        then += holds(by.detected[(k + count / 2) % count], location) ? 1 : 0;
      }
    }
  }
};

}  // namespace

std::vector<ComparedCameras> compare_cameras(std::span<const GroundInstant> instants, const CameraBias& agreement, int cameras) {
  std::vector<ComparedCameras> compared;
  if (cameras < 2 || instants.empty() || seconds(instants.back().time - instants.front().time) < kBriefest) return compared;
  const std::vector<Watcher> all = watchers(instants, agreement, cameras);
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      Appearances appearances;
      appearances.add(all[a], all[b]);
      appearances.add(all[b], all[a]);
      const int free = appearances.all - appearances.then;
      if (appearances.all < kMinAppearance || free < kMinFreeCount * appearances.all) continue;
      compared.push_back({CameraId{static_cast<int>(a)}, CameraId{static_cast<int>(b)},
                          std::max(0.0, static_cast<double>(appearances.now - appearances.then) / free)});
    }
  }
  return compared;
}

}  // namespace marey::track::ground
