// Foreground as evidence, point by point: no detections, but how much likelier each point of a grid is if something stands there.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "marey/detect/blobs/response_mixture.h"
#include "marey/detect/detector.h"

namespace marey::detect::blobs {

struct BlobDetectorOptions {
  static constexpr std::string_view name = "blobs";

  std::optional<int> step;  ///< px between the grid's points; nothing: 5
  int foreground_kinds = 16;
  /// Nats, of one point, at most and at least: neither model knows everything. Ours; the paper is not remembered to have a limit.
  double most_evidence = 4;
  int learning_frames = 40;  ///< where nothing could be read ahead: the scene is learned from so many frames, which show nobody
  std::uint64_t seed = 1;
};

/// Learns background and foreground from the samples it is primed with, and from then on neither changes.
class BlobDetector final : public Detector {
 public:
  /// Throws Error where an option is out of its domain.
  explicit BlobDetector(const BlobDetectorOptions& options);

  void prime(std::span<const Frame> samples) override;
  /// Detects nothing: `Detections::evidence` is what it says.
  Detections detect(const Frame& frame, std::span<const Expected> expected) override;

 private:
  void learn(const std::vector<cv::Mat>& seen);
  std::vector<Response> outliers(const std::vector<cv::Mat>& seen) const;

  BlobDetectorOptions options_;
  std::vector<cv::Mat> waiting_;  // responses of frames that will be learned from
  cv::Size grid_;
  std::vector<PointBackground> background_;  // row by row
  std::vector<ResponseKind> foreground_;
};

}  // namespace marey::detect::blobs
