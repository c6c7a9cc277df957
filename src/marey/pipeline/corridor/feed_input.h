// What a feed reads from: a file, another program's detections, a share of a file of observations, or a live camera. Files are
// asked for their next frame and block; live cameras are asked for what has arrived and never block.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/rig.h"
#include "marey/core/source.h"
#include "marey/source/live_time.h"

namespace marey::pipeline::corridor {

class FeedInput {
 public:
  virtual ~FeedInput() = default;
  virtual const SourceInfo& info() const = 0;
  virtual std::vector<std::string> warnings() const { return {}; }
  virtual bool has_images() const { return false; }
  virtual bool is_live() const { return false; }

  /// The next frame, with the camera's own time; nothing at the end. Waits for it. Nothing of a live camera.
  virtual std::optional<CameraFrame> next() { return std::nullopt; }
  /// Frames that have arrived since the last call, in order, with the camera's own times. None of a file.
  virtual std::vector<CameraFrame> arrived(const source::LivePolicy& /*policy*/) { return {}; }

  /// How a live camera is at this time; nothing of a file, whose state follows from the data read.
  virtual std::optional<FeedState> live_state(Timestamp /*begin*/, const source::LivePolicy& /*policy*/) const {
    return std::nullopt;
  }
  virtual bool has_ended() const { return false; }
  virtual bool is_connected() const { return true; }
  virtual CameraHealth health() const { return {}; }
  /// What to do if the rig's rate is not the live camera's; empty if it is.
  virtual std::string rate_warning() const { return {}; }
};

/// Throws Error if the region is not within images of this size from `source`.
void check_region(const cv::Rect& region, cv::Size size, const std::string& source);

/// Images, decoded up to `ahead` frames in advance on a thread of its own.
std::unique_ptr<FeedInput> image_input(std::unique_ptr<Source> source, int ahead);
/// What another program detected, boxes or blobs. Throws Error if it cannot be read.
std::unique_ptr<FeedInput> detection_input(const std::string& path, std::optional<double> rate_hz);
/// A camera that gives nothing.
std::unique_ptr<FeedInput> empty_input();
/// Observations of markers by all cameras of the rig, from one file or folder (format/observations.h): an input for each camera.
/// `rate_hz` counts for cameras of which neither the file nor the rig specifies it; without any it is 100 Hz.
std::vector<std::unique_ptr<FeedInput>> observation_inputs(const std::string& path, const Rig& rig, std::optional<double> rate_hz);
/// A live camera; its frames are cut to `camera`'s region, and `camera` gets their size if that is known already. Throws Error if
/// they do not fit the region or the calibration.
std::unique_ptr<FeedInput> live_input(RigCamera& camera, std::unique_ptr<LiveSource> source);

}  // namespace marey::pipeline::corridor
