// Names out of a learned set for markers in space, within the frame: a step that any stage takes, live too, and any recording that
// is read.
//
// Names are found from nothing over the last half second and more, in a task of its own: frames go by meanwhile. Its answer counts
// from half a second after it began; from then on a LabelFollower names every frame. Now and then the task looks anew at the last
// seconds, and what it then finds otherwise is put right.
//
// Each search ends with the check that a whole recording gets (solve/labels/check_names.h), over the last seconds. A name that
// could as well be exchanged with another is tracked, but not reported, until a search decides it; a later
// doubt, in a posture that tells less, takes no name away. How far the rigid
// distances are off the learned ones tells whether the set is of another person.
//
// A name is one track, whatever tracks its marker had: of the first track that gets a name the number becomes the name's, and all
// later ones that bear it are told under that. So what is recorded has each marker once, and who listens needs no list.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/learned_markers.h"
#include "marey/core/recording_reader.h"
#include "marey/core/stage_times.h"
#include "marey/solve/labels/find_names.h"

namespace marey::pipeline::markers {

/// Of a search in the last seconds, which somebody waits for.
solve::labels::LabelOptions live_label_options();

struct SetInSpaceOptions {
  solve::labels::LabelOptions find = live_label_options();
  solve::labels::LabelFollowOptions follow = {};
  bool wait = false;           ///< for the task, where it takes longer than half a second: results are then the same on any machine
  bool names_hold = true;      ///< what a track is called already it stays
  double first_after_s = 0.5;  ///< of points, that names are looked for in first
  double answer_after_s = 0.5;  ///< from when on it counts
  double remembered_s = 3;      ///< of points, that they are looked for in
  double looked_anew_s = 10;    ///< so often, once they are found
};

class SetInSpace {
 public:
  /// Throws Error where the set has fewer than four markers.
  SetInSpace(std::shared_ptr<const LearnedMarkers> set, double rate_hz, const SetInSpaceOptions& options = {});
  ~SetInSpace();
  SetInSpace(const SetInSpace&) = delete;
  SetInSpace& operator=(const SetInSpace&) = delete;

  void name(const TrackName& track) { names_before_[track.id] = track; }
  /// Its samples are told by name, its names are the set's and those that tracks had, `seen` and `boxes` follow.
  void add_to(Instant& instant);

  const StageTimes& times() const { return times_; }                ///< of a frame, without the task
  std::optional<double> found_at_s() const { return found_at_s_; }  ///< of the recording, when the first names counted
  double searched_s() const { return searched_s_; }                 ///< wall time of the longest search
  std::int64_t points() const { return points_; }                   ///< that were measured, since then
  std::int64_t named() const { return named_; }                     ///< of these with one of the set's names
  /// What its user should know at the end, one sentence each.
  std::vector<std::string> warnings() const;
  /// What its user should know now, since the last call: that the set does not fit, once.
  std::vector<std::string> news();

 private:
  struct Moment {
    std::int64_t index = 0;
    Timestamp time{};
    std::vector<solve::labels::TrackedPoint> points;
  };
  struct Searched {
    solve::labels::FoundNames found;
    std::string trouble;  // why nothing was found
    double seconds = 0;
  };

  void remember(const Instant& instant);
  void search(Timestamp now);
  void take_check(const solve::labels::FoundNames& found);
  std::optional<std::string> misfit() const;
  void take_answer(Timestamp now);
  static Searched search_in(const std::deque<std::shared_ptr<const Moment>>& recent, double rate_hz, const LearnedMarkers& set,
                            const SetInSpaceOptions& options, const std::stop_token& stop);
  int fixed_name(TrackId track) const;
  TrackId told_id(TrackId track, int name);
  TrackId fresh_id();
  void tell(Instant& instant);

  std::shared_ptr<const LearnedMarkers> set_;
  SetInSpaceOptions options_;
  double rate_hz_;
  std::map<std::string, int, std::less<>> name_of_label_;
  std::map<TrackId, TrackName> names_before_;  // as tracks come
  std::deque<std::shared_ptr<const Moment>> recent_;
  std::int64_t every_ = 1, count_ = 0;
  std::vector<solve::labels::TrackedPoint> points_now_;
  std::unique_ptr<solve::labels::LabelFollower> follower_;
  std::map<TrackId, int> given_;  // at this instant

  std::stop_source stop_;
  std::future<Searched> searching_;
  Timestamp searched_at_{};
  std::optional<Timestamp> first_point_, enough_since_;
  int searches_ = 0, failures_ = 0;
  std::vector<char> undecided_, decided_;    // by name: in doubt, and no search has decided it; by a search, once
  std::vector<double> misfits_, misfits_m_;  // of each search that found names
  bool misfit_reported_ = false;
  std::string trouble_;
  std::size_t most_points_ = 0;

  std::vector<std::optional<TrackId>> id_of_name_;
  std::map<TrackId, TrackId> told_of_;  // by track, of those without a name
  std::set<TrackId> used_;
  std::map<TrackId, TrackName> told_names_;

  StageTimes times_;
  std::optional<double> found_at_s_;
  double searched_s_ = 0;
  std::int64_t points_ = 0, named_ = 0;
  std::vector<std::int64_t> seen_;  // by name
};

/// The recording with the set's names: those of it that its tracks have count nothing. Throws Error where it has no points in
/// space.
std::unique_ptr<RecordingReader> with_set(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const LearnedMarkers> set,
                                          SetInSpaceOptions options);

}  // namespace marey::pipeline::markers
