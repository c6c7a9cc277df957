// Instants whose points wait for the tracker's decision to which track each of them belongs, and the labels of these tracks.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/instant.h"
#include "marey/core/marker_set.h"
#include "marey/core/track.h"
#include "marey/pipeline/markers/space_blobs.h"
#include "marey/reconstruct/correspond.h"
#include "marey/reconstruct/set_labels.h"

namespace marey::pipeline::markers {

class SpaceDecisions {
 public:
  /// `set`: gives labels by where its markers are, if it says that.
  explicit SpaceDecisions(const MarkerSet& set) : labels_(set) {}

  /// An instant whose points are those of `found`, of `blobs`; `tracks` as the tracker reports them before it decides.
  void add(const FrameSet& frames, const SpaceBlobs& blobs, const reconstruct::Correspondences& found,
           std::span<const Track<3>> tracks);

  /// The oldest instant that waits, with the samples of `tracks`, which the tracker decided for it.
  Instant decided(std::span<const Track<3>> tracks);

  /// px, root mean square over all points that belong to a track; nothing if there is no such point.
  std::optional<double> residual() const;

 private:
  struct Point {
    Sample sample;           // without its track
    std::vector<int> blobs;  // indices of the blobs behind it
  };
  struct Undecided {
    Instant instant;  // without samples
    std::vector<Point> points;
  };

  void label(const Track<3>& track, Instant& instant);

  reconstruct::SetLabels labels_;
  std::deque<Undecided> undecided_;
  std::map<TrackId, std::string> reported_labels_;
  std::int64_t points_ = 0;
  double squares_ = 0;  // px²
};

/// In a live run, markers that are not observed, for a while where they are expected.
class PredictedMarkers {
 public:
  /// `max_s`: how long after its last observation a marker is reported.
  explicit PredictedMarkers(double max_s) : max_s_(max_s) {}

  /// Adds them to an instant that holds the observed ones of `tracks`; samples are by track afterwards.
  void add_to(Instant& instant, std::span<const Track<3>> tracks);

 private:
  double max_s_;
  std::map<TrackId, Timestamp> observed_at_;
};

}  // namespace marey::pipeline::markers
