// One clock for all cameras: what their feeds deliver becomes sets of frames, one for each instant, with gaps explicit.
//
// The instants are either the frames of the first camera, or follow each other evenly at the rate of the fastest one, from the
// first frame of the earliest. Each camera contributes the frame that lies nearest to the instant, if that is less than half a
// frame away. A camera that stops, drops frames or is slower gives nothing to the instants it has no frame for; the others
// continue.
//
// Where `interpolate` is set, a camera that is unsynchronised by a part of a frame saw the markers somewhere else than they are at
// the instant: its detections are moved along the line between the frames before and after, each to the one of the other frame that
// is its nearest and to which it is the nearest. What has no such partner is omitted: its position is unknown.
//
// Live cameras (ClockOptions::live) are not waited for longer than the policy says. An instant is whole when every camera that
// gives frames has given its own. The newest whole one is given, what is older is dropped and counted by cause; where none is
// whole, the newest one that is late continues with its gaps. A camera that stalls is waited for no more, until it is back.
//
// Memory: a few frames a camera. Threads: cameras are asked for frames side by side; what comes out does not depend on them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/stage_times.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::corridor {

struct ClockOptions {
  enum class Pace {
    first_camera,  ///< an instant is a frame of the first camera
    even,          ///< instants follow each other at the rate of the fastest camera
  };
  Pace pace = Pace::first_camera;
  bool interpolate = false;
  std::optional<source::LivePolicy> live = {};  ///< the feeds are live cameras; the pace is even
  std::function<void()> waiting = {};           ///< called now and then while live cameras are waited for
};

/// Instants and frames that a live run drop.
struct LiveDrops {
  std::int64_t superseded = 0;   ///< instants that were whole, but so was a newer one: what follows is too slow
  std::int64_t incomplete = 0;   ///< instants that were not, when a newer one continued
  std::int64_t empty = 0;        ///< instants at which no camera gave anything
  std::int64_t late_frames = 0;  ///< that came when their instant had gone on
  std::int64_t overrun = 0;      ///< frames that left a camera's few kept ones before they were asked for
};

class FrameGrouping;

/// One clock for files and live cameras: which of the two, `options` decides.
class Clock {
 public:
  explicit Clock(std::vector<Feed> feeds, const ClockOptions& options = {});
  ~Clock();
  Clock(Clock&&) noexcept;
  Clock& operator=(Clock&&) noexcept;

  /// The next instant; nothing when the cameras have ended.
  std::optional<FrameSet> next();

  double rate_hz() const;
  /// How many instants there will be: an estimate, for progress only.
  std::optional<std::int64_t> count() const;
  const std::vector<Feed>& feeds() const;
  std::vector<Feed>& feeds();

  bool can_rewind() const;
  /// The same clock from the beginning, its feeds opened again: it gives the same instants, without detections. Throws Error if a
  /// feed cannot be read twice.
  Clock again() const;

  /// Frames that camera `number` gave, and how many instants it had nothing for.
  std::int64_t frames(std::size_t number) const;
  std::int64_t missed(std::size_t number) const;
  /// Nothing if the cameras are not live.
  std::optional<LiveDrops> drops() const;
  /// How each camera is now.
  std::vector<FeedState> states() const;
  const StageTimes& decoding() const;
  const StageTimes& detecting() const;
  std::vector<std::string> warnings() const;

 private:
  std::unique_ptr<FrameGrouping> grouping_;
};

/// The detections of a frame, moved to where they were `now` by those of another frame of the camera, before or after.
std::vector<Detection> moved_to(Timestamp now, const CameraFrame& nearest, const CameraFrame& other);

}  // namespace marey::pipeline::corridor
