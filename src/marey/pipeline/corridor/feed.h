// The one place that opens a camera. Whatever it is (a video file, a folder of images, another program's detections (boxes or
// blobs), a file of observations that several cameras share), its region, rate, offset and size are honoured here, and nowhere
// else.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/rig.h"
#include "marey/core/source.h"
#include "marey/core/stop.h"
#include "marey/detect/detector.h"
#include "marey/pipeline/corridor/marker_tuning.h"
#include "marey/source/live_time.h"

namespace marey::pipeline::corridor {

struct FeedOptions {
  std::optional<double> rate_hz = {};           ///< of a camera of which the rig does not specify it
  bool steady_times = false;                    ///< the camera keeps its rate: times that its file has rounded are corrected
  int ahead = 8;                                ///< frames that are decoded ahead, on a thread of its own; 0: none
  std::stop_token stop = StopScope::current();  ///< ends the waiting for a camera that is silent
  /// Opens images that another program holds, in place of the camera's `source`, which then only says what they are called.
  std::function<std::unique_ptr<Source>()> open = {};
  bool opens_again = false;  ///< `open` may be called often, and begins again each time
};

class FeedInput;

class Feed {
 public:
  /// Opens the camera's source, or its detections where it has no source. Throws Error, with the camera's name where it has one,
  /// where it has neither, cannot be read, its region is not within its images, or its calibration is for images of another
  /// shape.
  Feed(const RigCamera& camera, CameraId id, const FeedOptions& options = {});
  ~Feed();
  Feed(Feed&&) noexcept;
  Feed& operator=(Feed&&) noexcept;

  /// The camera as its images are: with their size, and its calibration scaled to it.
  const RigCamera& camera() const { return camera_; }
  CameraId id() const { return id_; }
  const SourceInfo& info() const;
  double rate_hz() const;
  bool has_images() const;
  /// The file whose sound goes with its images: none where they come from no video, or at another rate than its own.
  std::string sound_source() const;

  /// A camera that gives nothing.
  static Feed absent(const RigCamera& camera, CameraId id);
  /// A camera that does not wait for its reader: `arrived` is asked, not `next`. Where it is not connected yet, the rig's size and
  /// rate are trusted. Throws Error if its images do not fit the rig.
  static Feed live(const RigCamera& camera, CameraId id, std::unique_ptr<LiveSource> source);
  bool is_live() const;

  /// The feed searches for things itself from now on, in the frames' order.
  void find(std::unique_ptr<detect::Detector> detector);
  /// Of markers that came ready found those are omitted that lie in a mask.
  void tune(std::shared_ptr<const MarkerTuning> tuning) { tuning_ = std::move(tuning); }
  /// Its own detector; nothing if it has none.
  const detect::Detector* detector() const { return detector_.get(); }

  /// The next frame; nothing at the end. Its time is by the rig's clock: the camera's with `offset_s` added.
  std::optional<CameraFrame> next();
  /// Of a live camera, what has come since the last call, in order; never waits for it. Searched at once, where the feed does that,
  /// only with `all`: a feed that falls behind drops most of them.
  std::vector<CameraFrame> arrived(const source::LivePolicy& policy, bool all = true);
  /// Searches for things in a frame of this camera, where that has not been done.
  void search(CameraFrame& given);
  /// Of a live camera: whether it is there, and what happened to its frames.
  bool is_connected() const;
  CameraHealth health() const;
  /// The same with its state as it is now; `begin` is when the run began.
  CameraHealth health(Timestamp begin, const source::LivePolicy& policy) const;

  FeedState state() const { return state_; }
  bool has_ended() const;
  /// Of a live camera, as it is now; `begin` is when the run began.
  FeedState state(Timestamp begin, const source::LivePolicy& policy) const;

  /// Whether `again` works: a file does, a pipe or a live camera does not.
  bool can_rewind() const;
  /// The same camera from its beginning, without a detector. Throws Error if it cannot be read twice.
  Feed again() const;
  /// Makes what `again` does, later and often; empty if that cannot be read twice. The feed need not be there any more.
  std::function<Feed()> opener() const;
  /// At most `count` frames, spread evenly over the first `seconds`; the feed itself stays where it is. None where it cannot be
  /// read twice. Throws Stopped.
  std::vector<Frame> sample(int count, double seconds, int most_frames) const;
  /// What a detector learns the empty scene from: thirty frames of thirty seconds, of which 300 frames are read at most.
  std::vector<Frame> sample_beginning() const { return sample(30, 30, 300); }

  /// Of a live camera: what to do if the rig's rate is not the camera's own; empty if it is.
  std::string rate_warning() const;
  /// What went wrong so far without stopping it, one sentence each, with the camera's name where it has one.
  std::vector<std::string> warnings() const;

 private:
  class Life;
  friend std::vector<Feed> open_observations(const std::string& path, const Rig& rig, std::optional<double> rate_hz);

  Feed(const RigCamera& camera, CameraId id, const FeedOptions& options, std::unique_ptr<FeedInput> input);
  double stabilise(double time);
  CameraFrame by_rig_clock(CameraFrame frame) const;

  RigCamera camera_;
  CameraId id_;
  FeedOptions options_;
  std::unique_ptr<Life> life_;
  std::unique_ptr<FeedInput> input_;
  std::unique_ptr<detect::Detector> detector_;
  std::shared_ptr<const MarkerTuning> tuning_;
  std::optional<double> first_s_;
  FeedState state_ = FeedState::connecting;
};

/// Every camera of the rig, opened side by side. With `allow_absent`, cameras without source and detections give nothing, and only
/// a rig without any other is refused.
std::vector<Feed> open_feeds(const Rig& rig, const FeedOptions& options, bool allow_absent = false);

/// The rig with its cameras as their feeds are.
Rig rig_as_fed(const Rig& rig, const std::vector<Feed>& feeds);

/// What another program saw of markers, from a file or folder that format/observations.h reads: a feed for each of the rig's
/// cameras. `rate_hz` counts where the rig does not specify; without either it is 100 Hz.
std::vector<Feed> open_observations(const std::string& path, const Rig& rig, std::optional<double> rate_hz);

/// The error or warning with the camera's name before it, where it has one.
std::string stated_of(const RigCamera& camera, const std::string& message_text);

}  // namespace marey::pipeline::corridor
