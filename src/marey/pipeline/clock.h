// One clock for all cameras: what their feeds deliver becomes sets of frames, one for each moment, with gaps explicit.
//
// The moments are either the frames of the first camera, or follow each other evenly at the rate of the fastest one, from the first
// frame of the earliest. Each camera contributes the frame that lies nearest to the moment, if that is less than half a frame away.
// A camera that stops, drops frames or is slower gives nothing to the moments it has no frame for; the others go on.
//
// Where `interpolate` is set, a camera that is out of step by a part of a frame saw the markers somewhere else than they are at the
// moment: its detections are moved along the line between the frames before and after, each to the one of the other frame that is
// its nearest and to which it is the nearest. What has no such partner is left out: nobody knows where it was.
//
// Memory: a few frames a camera. Threads: cameras are asked for frames side by side; what comes out does not depend on them.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/pipeline/feed.h"
#include "marey/pipeline/stage_times.h"

namespace marey::pipeline {

struct ClockOptions {
  enum class Pace {
    first_camera,  ///< a moment is a frame of the first camera
    even,          ///< moments follow each other at the rate of the fastest camera
  };
  Pace pace = Pace::first_camera;
  bool interpolate = false;
};

class Clock {
 public:
  explicit Clock(std::vector<Feed> feeds, const ClockOptions& options = {});

  /// The next moment; nothing when the cameras have ended.
  std::optional<FrameSet> next();

  double rate_hz() const { return rate_hz_; }
  /// How many moments there will be: an estimate, for progress only.
  std::optional<std::int64_t> count() const;
  const std::vector<Feed>& feeds() const { return feeds_; }
  std::vector<Feed>& feeds() { return feeds_; }

  bool can_rewind() const;
  /// The same clock from the beginning, its feeds opened again: it gives the same moments, without detections. Throws Error where a
  /// feed cannot be read twice.
  Clock again() const;

  /// Frames that camera `number` gave, and how many moments it had nothing for.
  std::int64_t frames(std::size_t number) const { return lanes_[number].frames; }
  std::int64_t missed(std::size_t number) const { return lanes_[number].missed; }
  const StageTimes& decoding() const { return decoding_; }
  const StageTimes& detecting() const { return detecting_; }
  std::vector<std::string> warnings() const;

 private:
  struct Lane {
    std::deque<CameraFrame> waiting;
    std::optional<Timestamp> used;  // of the last frame given
    bool ended = false;
    std::int64_t frames = 0, missed = 0;
  };

  bool begin();
  void fill(Timestamp until);
  void read(std::size_t number, Timestamp until, std::vector<CameraFrame>& read);
  std::optional<CameraFrame> take(std::size_t number, Timestamp now);
  std::optional<Timestamp> next_moment();
  bool all_over(Timestamp now) const;

  ClockOptions options_;
  std::vector<Feed> feeds_;
  std::vector<Lane> lanes_;
  double rate_hz_ = 0;
  bool begun_ = false;
  std::optional<Timestamp> start_;
  std::int64_t next_ = 0;
  StageTimes decoding_, detecting_;
};

/// The detections of a frame, moved to where they were `now` by those of another frame of the camera, before or after.
std::vector<Detection> moved_to(Timestamp now, const CameraFrame& nearest, const CameraFrame& other);

}  // namespace marey::pipeline
