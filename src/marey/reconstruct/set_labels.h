#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "marey/core/marker_set.h"
#include "marey/core/track.h"
#include "marey/geometry/layout.h"

namespace marey::reconstruct {

/// Gives tracks the names of a marker set with places: the instant at which most of the set is seen as the file has it decides, and
/// later ones name those who were missing, while the set still keeps its shape.
class SetLabels {
 public:
  explicit SetLabels(const MarkerSet& set) : set_(set) {
    if (!set_.has_positions()) return;
    double nearest = kMaxWidth;
    for (std::size_t a = 0; a < set_.locations.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) nearest = std::min(nearest, (set_.locations[a] - set_.locations[b]).norm() / 3);
    }
    tolerance_ = std::max(nearest, kMinWidth);
  }

  void give(std::span<const Track<3>> tracks) {
    if (!set_.has_positions() || label_of_.size() == set_.labels.size() || frames_++ > kFrames) return;
    points_.clear();
    ids_.clear();
    for (const Track<3>& track : tracks) {
      if (!track.observation) continue;
      points_.push_back(track.position);
      ids_.push_back(track.id);
    }
    const auto match = geometry::match_layout(set_.locations, points_, tolerance_);
    if (!match) return;
    for (std::size_t m = 0; m < set_.labels.size(); ++m) {
      if (!match->point_of[m] || !given_.insert(m).second) continue;
      const TrackId id = ids_[static_cast<std::size_t>(*match->point_of[m])];
      if (!label_of_.emplace(id, set_.labels[m]).second) given_.erase(m);  // it has another name already
    }
  }

  const std::string& of(TrackId id) const {
    const auto found = label_of_.find(id);
    return found != label_of_.end() ? found->second : none_;
  }

 private:
  static constexpr double kMaxWidth = 0.03, kMinWidth = 0.001;  // m
  static constexpr int kFrames = 2000;                          // that are used

  MarkerSet set_;
  std::string none_;
  double tolerance_ = kMaxWidth;
  int frames_ = 0;
  std::vector<Vector<3>> points_;
  std::vector<TrackId> ids_;
  std::map<TrackId, std::string> label_of_;
  std::set<std::size_t> given_;
};

}  // namespace marey::reconstruct
