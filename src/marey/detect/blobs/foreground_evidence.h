// Foreground as evidence, point by point: no detections, but how much likelier each point of a grid is if something stands there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/blob_evidence.h"
#include "marey/core/frame.h"
#include "marey/detect/blobs/response_mixture.h"

namespace marey::detect::blobs {

struct ForegroundEvidenceOptions {
  std::optional<int> step;  ///< px between the grid's points; nothing: 5
  int foreground_kinds = 16;
  /// Nats, of one point, at most and at least: neither model knows everything. Ours; the paper is not remembered to have a limit.
  double max_evidence = 4;
  int learning_frames =
      40;  ///< where nothing could be read ahead: the scene is learned from this many frames, which show no person
  std::uint64_t seed = 1;
};

/// Learns background and foreground from the samples it is primed with, and from then on neither changes.
class ForegroundEvidence {
 public:
  /// Throws Error if an option is out of its domain.
  explicit ForegroundEvidence(const ForegroundEvidenceOptions& options);

  /// Frames sampled from the recording, before the first `of`; fewer than three are not enough.
  void prime(std::span<const Frame> samples);
  /// Of a frame; null while the scene is being learned. Throws Error if the size of frames changes.
  std::shared_ptr<const BlobEvidence> of(const Frame& frame);

 private:
  void learn(const std::vector<cv::Mat>& detected);
  std::vector<Response> outliers(const std::vector<cv::Mat>& detected) const;

  ForegroundEvidenceOptions options_;
  std::vector<cv::Mat> waiting_;  // responses of frames that will be learned from
  cv::Size grid_;
  std::vector<PointBackground> background_;  // row by row
  std::vector<ResponseKind> foreground_;
};

}  // namespace marey::detect::blobs
