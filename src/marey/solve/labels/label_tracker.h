// Names for markers within the frame, once they were found (find_names.h): nothing of what comes later is known.
//
// A track keeps its name while its distances to its steadiest named neighbours are about the learned ones, and while it lies on the
// learned side of those that are rigid with it. A track without a name, and one uncertain, are open; so are the names that no
// track has for certain. How well open names fit open tracks is the mean, since a track is open, of
//   - the distances to the neighbours, as DistanceModel has it,
//   - the side (four_points.h),
//   - where the name was lost: how far it lies from where its neighbours carried it since.
// Names are then assigned, each once; a name that fits badly, or barely better than something else could, stays open, and
// a margin is the lower the longer a track was inspected. Two that have each other's names are both uncertain, and both are right a
// frame later. Distances that are steady are learned in the process, one name's per frame.
// Cost: names × neighbours a frame, and open tracks × open names × neighbours.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/no_index.h"
#include "marey/core/ids.h"
#include "marey/core/learned_markers.h"
#include "marey/core/time.h"
#include "marey/solve/labels/distance_model.h"

namespace marey::solve::labels {

struct LabelTrackerOptions {
  DistanceOptions distances;
  std::size_t neighbours = 8;  ///< that say how well a name fits
  double min_fit = 6;          ///< nats, below which a name is not given
  double min_margin = 3;       ///< nats that a name must be better than what else could be, after many frames
  double first_margin = 4;     ///< times `min_margin` more is wanted at a track's first frame, half of it at the second, …
  double max_lack = 2;         ///< nats a neighbour by which a name's distances are off, and from which on it is uncertain
  double taken_after_s = 0.1;  ///< a name that is uncertain for this long, and does not fit, is taken away
};

/// One point of an instant, m.
struct TrackedPoint {
  TrackId track{};
  Vector<3> location = Vector<3>::Zero();
  int fixed = assign::kNoIndex;  ///< the name that a user gave it; it stays
};

class LabelTracker {
 public:
  /// `learned` must outlive it. `detected`: distances of each two names in the recording at hand, of none or all; `scale` as
  /// DistanceModel has it.
  LabelTracker(const LearnedMarkers& learned, double scale, std::span<const DistanceObserved> detected,
               const LabelTrackerOptions& options = {});

  /// Names that were found for tracks, by name: they replace the names these have, and a name is taken from its previous track.
  void take(const std::map<TrackId, int>& found);
  /// The names that tracks have, also those that are not there now.
  std::map<TrackId, int> borne() const;
  /// For every point its name or assign::kNoIndex; no name twice. Times grow. Valid until the next call.
  std::span<const int> step(Timestamp now, std::span<const TrackedPoint> points);

  std::size_t names() const { return locations_.size(); }
  std::size_t held() const { return held_; }  ///< names that were given in the last step

 private:
  struct Known {
    int name = assign::kNoIndex;
    Timestamp detected{};
    std::optional<Timestamp> flagged;  // since when
    double frames = 0;                 // that it is open, and that `sums` are of
    std::vector<double> sums;          // by name

    void start(std::size_t names) { frames = 0, sums.assign(names, 0); }
  };
  struct Side {
    std::array<std::size_t, 3> others{};
    double height = 0;  // m, as learned, of the name over the others
  };
  struct Lost {
    Timestamp at{};
    Vector<3> location = Vector<3>::Zero();
    std::array<std::size_t, 6> others{};
    std::array<Vector<3>, 6> their_positions{};
    std::size_t count = 0;
    std::optional<Vector<3>> expected;  // at this frame
    double deviation = 0;               // m
  };

  void find_points(Timestamp now, std::span<const TrackedPoint> points);
  void note_lost();
  void find_uncertain_names(Timestamp now, std::span<const TrackedPoint> points);
  void expect_lost(Timestamp now);
  void weigh(std::span<const TrackedPoint> points);
  void distribute(Timestamp now);
  double margin(std::size_t open, std::size_t name) const;
  void give(std::size_t point, int name);
  void learn(Timestamp now);
  void refine(std::size_t name);
  void find_sides(std::size_t name);
  bool posture_varied() const;

  double lack(std::size_t name, const Vector<3>& location) const;
  double fit(std::size_t name, const Vector<3>& location, std::size_t self) const;
  double side_cost(std::size_t name, const Vector<3>& location, std::size_t self) const;
  double lost_gain(std::size_t name, const Vector<3>& location) const;

  const LearnedMarkers* learned_;
  LabelTrackerOptions options_;
  DistanceModel first_, model_;  // as learned; with the observations since
  std::vector<DistanceObserved> detected_;
  std::vector<std::vector<Side>> sides_;
  std::map<TrackId, Known> known_;
  std::vector<Known*> of_point_;
  std::vector<int> given_;                                    // by point
  std::vector<std::optional<Vector<3>>> locations_, before_;  // by name: now, in the frame before
  std::vector<char> trusted_, names_open_;
  std::vector<std::optional<Lost>> lost_;
  std::vector<std::size_t> open_;             // points
  std::vector<std::vector<double>> weights_;  // by open point and name
  std::vector<int> shared_;
  std::vector<assign::GatedPair> pairs_;
  assign::GatedAssigner assigner_;
  Timestamp before_at_{};
  std::optional<Timestamp> learned_at_;
  std::size_t refined_ = 0, held_ = 0;
};

}  // namespace marey::solve::labels
