#pragma once

#include <string>

#include "marey/core/sink.h"
#include "marey/draw/mask_folder.h"

namespace marey::pipeline::people {

/// The visible part of every target's contour as a folder of images, one a frame: PNG of 16 bits, each pixel the number of the
/// target that it shows, 0 for the background.
class TargetMaskSink final : public Sink {
 public:
  /// The folder is made now. Throws Error if it cannot be made, or holds something.
  explicit TargetMaskSink(const std::string& folder) : folder_(folder, "target"), name_(folder) {}

  std::string name() const override { return name_; }
  SinkRequirements begin(const RecordingHeader& header) override;
  /// Throws Error if the image's size is not known, or a target has a number that 16 bits do not hold.
  void write(const Instant& instant) override;
  void finish() override { folder_.finish(); }

 private:
  draw::MaskFolder folder_;
  std::string name_;
  cv::Size size_;  // empty until known
};

}  // namespace marey::pipeline::people
