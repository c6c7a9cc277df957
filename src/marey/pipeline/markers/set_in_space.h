// Names out of a learned set for markers in space, within the frame: a step that any stage takes, live too, and any recording that
// is read.
//
// Names are found from nothing over the last half second and more, in a task of its own: frames go by in the meantime. Its answer
// counts from half a second after it began; from then on a LabelTracker names every frame. Now and then the task searches again the
// last seconds, and what it then finds otherwise is corrected.
//
// Each search ends with the check that a whole recording gets (solve/labels/check_names.h), over the last seconds. A name that
// could as well be exchanged with another is tracked, but not reported, until a search decides it; a later
// doubt, in a posture that shows less, takes no name away. How far the rigid
// distances are off the learned ones shows whether the set is of another person.
//
// A name is one track, whatever tracks its marker had: of the first track that gets a name the number becomes the name's, and all
// later ones that have it are reported under that. So the recording has each marker once, and a client needs no list.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/learned_markers.h"
#include "marey/core/recording_reader.h"
#include "marey/core/stage_times.h"
#include "marey/pipeline/markers/set_check.h"
#include "marey/pipeline/markers/set_search.h"
#include "marey/pipeline/markers/set_track_ids.h"
#include "marey/solve/labels/find_names.h"

namespace marey::pipeline::markers {

class LiveLabelling {
 public:
  /// Throws Error if the set has fewer than four markers.
  LiveLabelling(std::shared_ptr<const LearnedMarkers> set, double rate_hz, const SetInSpaceOptions& options = {});

  void name(const TrackName& track) { names_before_[track.id] = track; }
  /// Its samples are reported by name, its names are the set's and those that tracks had, `seen` and `boxes` follow.
  void add_to(Instant& instant);

  const StageTimes& times() const { return times_; }                       ///< of a frame, without the task
  std::optional<double> found_at_s() const { return counts_.found_at_s; }  ///< of the recording, when the first names counted
  double searched_s() const { return search_.longest_s(); }                ///< wall time of the longest search
  std::int64_t points() const { return counts_.points; }                   ///< that were measured, since then
  std::int64_t named() const { return counts_.named; }                     ///< of these with one of the set's names
  /// What its user should know at the end, one sentence each.
  std::vector<std::string> warnings() const;
  /// What its user should know now, since the last call: that the set does not fit, once.
  std::vector<std::string> news();

 private:
  struct Counts {
    std::size_t max_points = 0;          // at an instant
    std::int64_t points = 0, named = 0;  // since labels were found
    std::vector<std::int64_t> observed;  // by label
    std::optional<double> found_at_s;
  };

  void note_points(const Instant& instant);
  void take_answer(Timestamp now);
  void label_points(Timestamp now);
  void relabel(Instant& instant);
  TrackName reported_name(TrackId track);
  std::size_t found() const;
  int fixed_name(TrackId track) const;

  std::shared_ptr<const LearnedMarkers> set_;
  bool names_hold_;
  std::map<std::string, int, std::less<>> name_of_label_;
  std::map<TrackId, TrackName> names_before_;  // as tracks come
  std::vector<solve::labels::TrackedPoint> points_now_;
  std::unique_ptr<solve::labels::LabelTracker> target_tracker_;
  std::map<TrackId, int> given_;  // at this instant
  SetSearch search_;
  SetCheck check_;
  SetTrackIds ids_;
  Counts counts_;
  StageTimes times_;
};

/// The recording with the set's names: those of it that its tracks have count nothing. Throws Error if it has no points in
/// space.
std::unique_ptr<RecordingReader> with_set(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const LearnedMarkers> set,
                                          SetInSpaceOptions options);

}  // namespace marey::pipeline::markers
