#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/detect/network/network_options.h"
#include "marey/detect/network/run_network.h"
#include "marey/detect/network/tiles.h"

namespace marey::detect::network {

/// People found by a network in tiles of each picture, alone or beside a background model. Beside it a person whom both see is
/// as the background model measured it, people who share one region are those whom the network sees in it, and who stands since
/// the first frame, whom only the network sees, is added. Boxes end at the tip of the foot, as silhouettes do.
class NetworkDetector final : public Detector {
 public:
  /// Throws Error where the model or its network is not usable.
  explicit NetworkDetector(const NetworkDetectorOptions& options);

  void prime(std::span<const Frame> samples) override;
  Detections detect(const Frame& frame, std::span<const Expected> expected) override;
  DetectorTraits traits() const override { return {.toe_m = 0.1, .has_foreground = options_.background, .knows_body_size = true}; }
  DetectionCounts detection_counts() const override;
  std::optional<Box> body_at(const Vector<2>& foot) const override;

  /// What the network alone sees in the picture, looking everywhere. Learns nothing but the size of people.
  std::vector<Detection> look(const Frame& frame);

 private:
  std::optional<people::PersonSize> size_at(double x, double y) const;
  std::vector<cv::Rect> tiles_of(cv::Size picture) const;
  std::vector<Detection> look_at(const Frame& frame, std::span<const cv::Rect> tiles);
  void learn(std::span<const Detection> found, cv::Size picture);
  std::vector<Detection> joined(const std::vector<Detection>& moving, const std::vector<Detection>& seen) const;

  NetworkDetectorOptions options_;
  LoadedNetwork network_;
  std::unique_ptr<people::PeopleDetector> moving_;  // none without a background model
  people::PersonSizeModel sizes_;
  std::optional<Timestamp> looked_everywhere_;
  std::int64_t frames_ = 0, misfits_ = 0;
};

}  // namespace marey::detect::network
