#include "marey/pipeline/take/play.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "marey/core/error.h"

namespace marey::pipeline::take {
namespace {

using MonotonicClock = std::chrono::steady_clock;

/// Waits until then, and checks the token now and then; false if it is to stop.
bool wait_until(MonotonicClock::time_point due, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto now = MonotonicClock::now();
    if (now >= due) return true;
    std::this_thread::sleep_until(std::min(due, now + kStopSlice));
  }
  return false;
}

/// One playing, over all rounds.
class Player {
 public:
  Player(const std::vector<std::unique_ptr<Sink>>& sinks, const PlayOptions& options, stream::CaptureClock* clock,
         const Hooks& hooks)
      : sinks_(sinks), options_(options), clock_(clock), hooks_(hooks) {}

  /// From the first instant to the last; false where it was stopped.
  bool round(RecordingReader& reader) {
    ++summary_.rounds;
    if (summary_.rounds == 1) begin(reader.header());
    const std::vector<TrackName> names = reader.tracks();
    bool first = true;
    auto instant = reader.next();
    while (instant) {
      if (first) {
        start_round(*instant);
        instant->named.insert(instant->named.begin(), names.begin(), names.end());
      }
      first = false;
      auto next = reader.next();
      if (!give(std::move(*instant), next ? std::optional(next->time) : std::nullopt, reader.instant_count())) return false;
      instant = std::move(next);
    }
    if (first) throw Error("{}: holds not one instant to play", reader.header().name);
    summary_.warnings = reader.warnings();
    return true;
  }

  PlaySummary finish(bool stopped) {
    for (const auto& sink : sinks_) sink->finish();
    summary_.stopped = stopped;
    summary_.seconds = std::chrono::duration<double>(MonotonicClock::now() - began_).count();
    return std::move(summary_);
  }

 private:
  void begin(RecordingHeader header) {
    if (header.name.empty()) header.name = options_.name;
    for (const auto& sink : sinks_) sink->begin(header);
    period_ = duration_from_seconds(1 / header.rate_hz);
    began_ = origin_ = MonotonicClock::now();
  }

  /// A later round continues where the last one ended: its indices and its times are moved.
  void start_round(const Instant& first) {
    index_shift_ = next_index_ - first.index;
    time_shift_ = next_time_ - first.time.time_since_epoch();
    if (summary_.rounds == 1) index_shift_ = 0, time_shift_ = Duration::zero();
    const Timestamp time = first.time + time_shift_;
    const auto due = summary_.rounds == 1 ? MonotonicClock::now() : std::max(MonotonicClock::now(), due_at(time));
    zero_ = time;
    origin_ = due;
    if (clock_ != nullptr) clock_->set(time, std::chrono::nanoseconds(due.time_since_epoch()).count(), options_.speed);
  }

  MonotonicClock::time_point due_at(Timestamp time) const {
    return origin_ + std::chrono::nanoseconds(std::llround(static_cast<double>((time - zero_).count()) / options_.speed));
  }

  /// False where it was stopped. `following`: the time of the next instant, as read.
  bool give(Instant instant, std::optional<Timestamp> tracking, std::optional<std::int64_t> total) {
    instant.index += index_shift_;
    instant.time += time_shift_;
    next_index_ = instant.index + 1;
    next_time_ = instant.time.time_since_epoch() + period_;
    keep_names(instant);
    if (!is_required(instant.time)) {
      ++summary_.excluded;
      return !hooks_.stop.stop_requested();
    }
    const auto due = due_at(instant.time);
    const auto now = MonotonicClock::now();
    if (now - due > kTooLate && tracking && due_at(*tracking + time_shift_) <= now) {
      ++summary_.skipped;
      return !hooks_.stop.stop_requested();
    }
    if (!wait_until(due, hooks_.stop)) return false;
    instant.named = std::exchange(names_, {});
    for (const auto& sink : sinks_) sink->write(instant);
    ++summary_.instants;
    if (total) total = *total * (options_.loop ? summary_.rounds : 1);
    const std::int64_t done = summary_.instants + summary_.excluded + summary_.skipped;
    return hooks_.report({"playing", done, options_.loop ? std::nullopt : total}) == Continue::yes;
  }

  /// Names of an instant that is omitted go with the next one.
  void keep_names(Instant& instant) {
    names_.insert(names_.end(), std::make_move_iterator(instant.named.begin()), std::make_move_iterator(instant.named.end()));
    instant.named.clear();
  }

  bool is_required(Timestamp time) {
    if (!options_.rate_hz) return true;
    const Duration step = duration_from_seconds(1 / *options_.rate_hz);
    if (required_ && time + period_ / 2 < *required_) return false;
    required_ = required_ && time - *required_ < step ? *required_ + step : time + step;
    return true;
  }

  const std::vector<std::unique_ptr<Sink>>& sinks_;
  const PlayOptions& options_;
  stream::CaptureClock* clock_;
  const Hooks& hooks_;
  PlaySummary summary_;
  MonotonicClock::time_point began_, origin_;
  Timestamp zero_{};  // is due at the origin
  Duration period_{}, time_shift_{}, next_time_{};
  std::int64_t index_shift_ = 0, next_index_ = 0;
  std::optional<Timestamp> required_;
  std::vector<TrackName> names_;
};

}  // namespace

PlaySummary play(const std::function<std::unique_ptr<RecordingReader>()>& open, const std::vector<std::unique_ptr<Sink>>& sinks,
                 const PlayOptions& options, stream::CaptureClock* clock, const Hooks& hooks) {
  const StopScope finishes_in_order{{}};  // what listens is reported that it is over
  Player player(sinks, options, clock, hooks);
  bool goes_on = true;
  do {
    const auto reader = open();
    goes_on = player.round(*reader);
  } while (goes_on && options.loop);
  return player.finish(!goes_on);
}

}  // namespace marey::pipeline::take
