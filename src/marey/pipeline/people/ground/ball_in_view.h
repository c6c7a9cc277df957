// Candidates for the ball in one camera's images.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/frame.h"
#include "marey/core/ground_views.h"
#include "marey/detect/ball/ball_detector.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ball/ball_observations.h"

namespace marey::pipeline::people::ground {

class BallInView {
 public:
  /// Of a calibrated camera that is static.
  BallInView(CameraId id, const GroundView& view, const reconstruct::GroundArea& area,
             const detect::ball::BallDetectorOptions& options);

  /// Frames of the beginning, before the first `search`.
  void prime(const std::vector<Frame>& samples) { detector_.prime(samples); }
  /// `people`: their detections in this frame.
  void search(const Frame& frame, const std::vector<Detection>& people);
  /// Of the last frame; nothing before the first.
  const std::optional<track::ball::BallView>& candidates() const { return candidates_; }

 private:
  CameraId id_;
  detect::ball::BallDetector detector_;
  std::optional<track::ball::BallView> candidates_;
};

}  // namespace marey::pipeline::people::ground
