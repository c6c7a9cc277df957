// How frames of several cameras become sets of frames: what files and live cameras share. clock.h describes both.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/stage_times.h"
#include "marey/pipeline/corridor/clock.h"

namespace marey::pipeline::corridor {

class FrameGrouping {
 public:
  virtual ~FrameGrouping() = default;

  /// The next frame set; nothing when the cameras have ended.
  virtual std::optional<FrameSet> next() = 0;
  /// How each camera is now.
  virtual std::vector<FeedState> states() const = 0;
  /// What a live run dropped; nothing for files, which drop nothing.
  virtual std::optional<LiveDrops> drops() const { return std::nullopt; }

  /// Frames of one camera that wait for their instant, and counts of all.
  struct Lane {
    std::deque<CameraFrame> waiting;
    std::optional<Timestamp> used;  // of the last frame given
    bool ended = false;
    std::int64_t frames = 0, missed = 0;
  };

  const ClockOptions& options() const { return options_; }
  std::vector<Feed>& feeds() { return feeds_; }
  const Lane& lane(std::size_t camera) const { return lanes_[camera]; }
  double rate_hz() const { return rate_hz_; }
  const StageTimes& decoding() const { return decoding_; }
  const StageTimes& detecting() const { return detecting_; }

 protected:
  static constexpr double kHalf = 0.505;   // of a frame: a camera's frame that is nearer belongs to the instant
  static constexpr double kInStep = 0.02;  // of a frame: what moves no marker by more than noise

  FrameGrouping(std::vector<Feed>&& feeds, const ClockOptions& options, double rate_hz);

  /// The camera's frame that is nearest to `now`, its detections moved to that time if that is an option; nothing if none is within
  /// half a frame, which is counted.
  std::optional<CameraFrame> take(std::size_t camera, Timestamp now);

  ClockOptions options_;
  std::vector<Feed> feeds_;
  std::vector<Lane> lanes_;  // by camera
  double rate_hz_ = 0;
  std::optional<Timestamp> start_;
  std::int64_t next_ = 0;
  StageTimes decoding_, detecting_;

 private:
  std::optional<std::size_t> nearest(const Lane& lane, Timestamp now) const;
  void move_to(Timestamp now, std::size_t camera, std::size_t nearest, CameraFrame& frame) const;
};

/// Files: they are waited for, and nothing is dropped.
std::unique_ptr<FrameGrouping> group_files(std::vector<Feed> feeds, const ClockOptions& options);
/// Live cameras, which `options.live` says how long to wait for.
std::unique_ptr<FrameGrouping> group_live(std::vector<Feed> feeds, const ClockOptions& options);

}  // namespace marey::pipeline::corridor
