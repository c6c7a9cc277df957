#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/geometry/similarity2.h"
#include "marey/track/image/clothing.h"

namespace marey::track::offline {

/// One target in one frame, as small as a match of 90 minutes needs it: 76 bytes. px and px/s.
struct TrackRow {
  std::int32_t frame = 0;  ///< 0-based
  std::int32_t id = 0;
  std::int32_t first_id = 0;                       ///< what the tracker called it; `id` is given again when tracklets are joined
  float x = 0, y = 0;                              ///< position
  float vx = 0, vy = 0;                            ///< velocity
  float left = 0, top = 0, width = 0, height = 0;  ///< box; width and height are 0 where the target has no extent
  float centre_x = 0, centre_y = 0;                ///< of the outline, where `has_centre`
  float score = 1;
  Provenance provenance = Provenance::measured;
  image::PackedClothes clothes;  ///< of the observations of it
  bool ambiguous = false;        ///< others were so near that it may be one of them: set by the second pass (ambiguous_intervals.h)
  bool has_centre = false;       ///< an outline was found; after smoothing, also where one was found shortly before and after

  bool observed() const { return provenance == Provenance::measured; }
  bool has_box() const { return width > 0 && height > 0; }
};

/// What a tracker said, frame by frame, kept for a second pass. Targets that are never confirmed are forgotten as they end.
class TrackletLog {
 public:
  /// One target's rows in the order of frames, without gaps: frames in which it was not seen are predicted.
  using Tracklet = std::vector<TrackRow>;

  /// The tracks of one frame, as Tracker<2>::step gave them. Frames come in order, each once. `clothes` are those of the frame's
  /// observations, by their index; empty if they are not known. Rows are kept in coordinates that stand still where the camera
  /// moves: `view_from_scene` is Tracker::view_from_scene after that step.
  void add(std::int64_t frame, Timestamp time, std::span<const Track<2>> tracks, std::span<const image::Clothes> clothes = {},
           const geometry::Similarity2& view_from_scene = {});

  /// A row of this log, in px of its frame's image.
  TrackRow in_view(const TrackRow& row) const;

  /// Time of frames: the one at `frame`, which was added.
  Timestamp time_of(std::int32_t frame) const;

  /// Every confirmed target, in the order of ids. The recording is empty afterwards, but for its times and the camera's motion.
  std::vector<Tracklet> take_tracklets();

 private:
  struct Open {
    Tracklet rows;
    bool confirmed = false;
  };

  void close(Open& open);

  std::vector<Timestamp> times_;
  std::vector<geometry::Similarity2> views_from_scene_;  // of every frame; empty as long as the camera has stood still
  std::int32_t first_frame_ = 0;
  std::vector<Open> open_;  // by id
  std::vector<Tracklet> closed_;
};

}  // namespace marey::track::offline
