// The tracks of one camera's frames, kept for the second pass.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/geometry/similarity2.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/image_tracking.h"
#include "marey/track/offline/join.h"
#include "marey/track/offline/outline_log.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::pipeline::people {

class ImageLog {
 public:
  /// `spill_path`: contours wait in a nameless file next to this path. `with_lines`: their measurement lines too.
  ImageLog(bool contours, std::string spill_path, bool with_lines);

  /// A frame in which no person was searched: its rows are interpolated.
  void add_unsearched(const Frame& frame) { time_steps_.push_back({frame.index, frame.time}); }
  /// A frame that was searched; then `add` of its tracks.
  void add_searched(const Frame& frame);
  /// The tracks of searched frame `number`, which counts those.
  void add(std::int64_t number, std::span<const Track<2>> tracks, std::span<const track::image::Clothes> clothes,
           const geometry::Similarity2& view_from_scene);

  std::int64_t searched() const { return std::ssize(searched_); }
  std::int64_t frames() const { return std::ssize(time_steps_); }
  Timestamp time_of(std::int64_t number) const;
  bool has_contours() const { return contours_ != nullptr; }

  /// The tracks so far; from now on the frames are the same, and nothing is tracked in them.
  struct Tracked {
    track::offline::TrackletLog tracks;
    std::unique_ptr<track::offline::OutlineLog> contours;
  };
  Tracked begin_again();
  void restore(Tracked tracked);

  /// The second pass. The log must outlive the result.
  std::unique_ptr<corridor::InstantSource> finish(const track::offline::JoinOptions& options, track::offline::JoinReport& report,
                                                  bool observed_only);

 private:
  std::unique_ptr<track::offline::OutlineLog> new_contours() const;

  bool with_contours_;
  std::string spill_path_;
  bool with_lines_;
  track::offline::TrackletLog tracks_;
  std::unique_ptr<track::offline::OutlineLog> contours_;  // null: none
  std::vector<Recording::TimeStep> time_steps_;
  std::vector<std::int32_t> searched_;  // indices into `moments_`: the log counts these
};

}  // namespace marey::pipeline::people
