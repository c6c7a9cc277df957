#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/time.h"

namespace marey::track::ground {

/// Finds targets that are one person: cameras that disagree about the place of a person may each feed a target of its own. Two
/// that one camera saw in one frame are two people. Two that stay together for a while, each seen, and never both by one camera,
/// are one, whether each is fed by a camera of its own or all feed both by turns. With one camera nothing is ever merged.
/// Cost: targets · neighbours an instant.
class GroundDuplicates {
 public:
  struct Member {
    TrackId id{};
    Vector<2> position = Vector<2>::Zero();        ///< m
    Matrix<2> covariance = Matrix<2>::Identity();  ///< m²
    CameraMask cameras = 0;                        ///< those that saw it at this instant
  };

  /// Pairs of the target that stays and the one that goes, the older staying; none goes twice or stays after going. `members` are
  /// by id; `disagreement` in m: how far apart two cameras see one person, standard deviation. Valid until the next call.
  const std::vector<std::pair<TrackId, TrackId>>& find(Timestamp now, std::span<const Member> members, double disagreement);

 private:
  struct Pair {
    Timestamp since{};  // they have been together, and no camera saw both
    Timestamp latest{};
    CameraMask first = 0, second = 0;  // those that saw them in the meantime
  };
  bool together(const Member& a, const Member& b, double disagreement) const;

  std::map<std::pair<TrackId, TrackId>, Pair> pairs_;
  std::vector<std::pair<TrackId, TrackId>> merges_;
  std::vector<int> by_x_;
};

}  // namespace marey::track::ground
