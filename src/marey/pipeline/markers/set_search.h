// The search for a learned set's labels over the last seconds, in a task of its own, while frames go by.
//
// The first search begins half a second after enough markers are observed, later ones from time to time. A search's answer counts
// from half a second after it began, so that it does not depend on how fast the machine is.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "marey/core/learned_markers.h"
#include "marey/core/time.h"
#include "marey/solve/labels/find_names.h"

namespace marey::pipeline::markers {

/// Label search over the last few seconds, with bounded run time, for live use.
solve::labels::LabelOptions live_label_options();

struct SetInSpaceOptions {
  solve::labels::LabelOptions find = live_label_options();
  solve::labels::LabelTrackerOptions tracking = {};
  bool wait = false;           ///< for the task, where it takes longer than half a second: results are then the same on any machine
  bool names_hold = true;      ///< what a track is called already it stays
  double first_after_s = 0.5;  ///< of points, that names are searched for in first
  double answer_after_s = 0.5;  ///< from when on it counts
  double remembered_s = 3;      ///< of points, that they are searched for in
  double search_again_s = 10;   ///< this often, once they are found
};

/// The points of the last seconds, about a hundred times per second.
class RecentPoints {
 public:
  RecentPoints(double rate_hz, double duration_s);

  void add(std::int64_t index, Timestamp time, std::span<const solve::labels::TrackedPoint> points);

  struct Instant {
    std::int64_t index = 0;
    Timestamp time{};
    std::vector<solve::labels::TrackedPoint> points;
  };
  using Instants = std::deque<std::shared_ptr<const Instant>>;
  const Instants& instants() const { return instants_; }
  /// Of the instants that are kept.
  double rate_hz() const { return rate_hz_ / static_cast<double>(every_); }

 private:
  double rate_hz_, duration_s_;
  std::int64_t every_, count_ = 0;
  Instants instants_;
};

class SetSearch {
 public:
  static constexpr double kMinObserved = 0.4;  ///< of the set's markers, below which nothing is searched; as label_recording has it

  SetSearch(std::shared_ptr<const LearnedMarkers> set, double rate_hz, const SetInSpaceOptions& options);
  ~SetSearch();
  SetSearch(const SetSearch&) = delete;
  SetSearch& operator=(const SetSearch&) = delete;

  /// The points of an instant, for later searches.
  void remember(std::int64_t index, Timestamp time, std::span<const solve::labels::TrackedPoint> points) {
    recent_.add(index, time, points);
  }
  /// Begins a search if none runs and there is a reason: `points` are observed now, and `held` of the set's labels are given;
  /// nothing: none was ever found.
  void begin_if_due(Timestamp now, std::size_t points, std::optional<std::size_t> held);
  /// The answer of the search that ran, from when it counts; nothing if it found nothing.
  std::optional<solve::labels::FoundNames> answer(Timestamp now);

  double longest_s() const { return longest_s_; }          ///< wall time of the longest search
  const std::string& failure() const { return failure_; }  ///< why the last search that failed did
  static double min_points(const LearnedMarkers& set);     ///< fewer are not searched

 private:
  struct Answer {
    solve::labels::FoundNames found;
    std::string failure;  // why nothing was found
    double seconds = 0;
  };

  bool is_due(Timestamp now, std::size_t points, std::optional<std::size_t> held) const;
  static Answer search_in(const RecentPoints::Instants& recent, double rate_hz, const LearnedMarkers& set,
                          const SetInSpaceOptions& options, const std::stop_token& stop);

  std::shared_ptr<const LearnedMarkers> set_;
  SetInSpaceOptions options_;
  RecentPoints recent_;
  std::stop_source stop_;
  std::future<Answer> running_;
  Timestamp begun_at_{};
  std::optional<Timestamp> enough_since_;
  int searches_ = 0, failures_ = 0;
  std::string failure_;
  double longest_s_ = 0;
};

}  // namespace marey::pipeline::markers
