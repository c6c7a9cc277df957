// How a live run goes, while it does: every camera's state, rate and losses, how old results are, what was dropped and why.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/stage_times.h"
#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::corridor {

struct LiveStatus {
  double seconds = 0;  ///< since the run began
  std::vector<CameraHealth> cameras;
  LiveDrops drops;
  std::int64_t instants = 0;                              ///< so far
  std::int64_t targets = 0;                               ///< in the last one
  std::optional<double> latency_median_s, latency_p99_s;  ///< from exposure to the instant, over the last few seconds
  bool recording = false;
  std::vector<std::string> troubles;  ///< of sinks, one sentence each
  std::vector<std::string> news;      ///< the last few things that were found out, one sentence each
  std::int64_t news_count = 0;        ///< how many there were so far
};

/// Watches a clock and what is made of its instants. All from the run's own thread.
class LiveMonitor {
 public:
  using Notify = std::function<void(const LiveStatus&)>;

  /// `notify` is called four times a second; it may be empty.
  LiveMonitor(std::shared_ptr<source::LiveTime> time, Notify notify);

  /// What is watched: it must outlive the monitor's use. Before the first call of `saw`.
  void watch(const Clock& clock, const Sinks& sinks);
  /// An instant continued, and instants results from it.
  void observed(const FrameSet& frames, std::span<const Instant> instants, Timestamp given, Timestamp done);
  /// What the job found out, one sentence each.
  void received(const std::vector<std::string>& news);
  /// Time continues.
  void tick();

  LiveStatus status() const;
  /// Of the whole run: "capture to group", "group to instant", "capture to instant".
  std::vector<Summary::StepTime> steps() const;
  void set_recording(std::function<bool()> recording) { recording_ = std::move(recording); }

 private:
  void measure_rates(Timestamp now);

  std::shared_ptr<source::LiveTime> time_;
  Notify notify_;
  const Clock* clock_ = nullptr;
  const Sinks* sinks_ = nullptr;
  std::function<bool()> recording_;
  Timestamp begin_{};
  std::optional<Timestamp> reported_, measured_, window_;
  StageTimes grouping_, solving_, all_, recent_, before_;
  std::vector<double> rates_;
  std::vector<std::int64_t> frames_, detections_;
  std::vector<FeedState> states_;
  std::int64_t instants_ = 0, targets_ = 0, news_count_ = 0;
  std::vector<std::string> news_;
};

}  // namespace marey::pipeline::corridor
