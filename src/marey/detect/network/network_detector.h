#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/detect/network/image_cells.h"
#include "marey/detect/network/network_options.h"
#include "marey/detect/network/run_network.h"
#include "marey/detect/network/tiles.h"

namespace marey::detect::network {

/// People found by a network in tiles of each image, alone or beside a background model. Beside it a person that both see is
/// as the background model measured it, people who share one region are those that the network sees in it, and one who stands since
/// the first frame, that only the network sees, is added. Boxes end at the tip of the foot, as silhouettes do. The network runs
/// where it may find something new: all over the image now and then; in between where people share a region, where a person
/// appears, or is expected and not found. One who stands with the same pixels as when the network found them is found again
/// without it.
class NetworkDetector final : public Detector {
 public:
  /// Throws Error if the model or its network is not usable.
  explicit NetworkDetector(const NetworkDetectorOptions& options);

  void prime(std::span<const Frame> samples) override;
  Detections detect(const Frame& frame, std::span<const Expected> expected) override;
  DetectorTraits traits() const override { return {.toe_m = 0.1, .has_foreground = options_.background, .knows_body_size = true}; }
  DetectionCounts detection_counts() const override;
  std::optional<Box> body_at(const Vector<2>& foot) const override;

  /// Parts of images that the network was run on so far.
  std::int64_t tiles_searched() const { return tiles_; }

  /// What the network alone sees in the image, searching everywhere. Learns nothing but the size of people.
  std::vector<Detection> people_everywhere(const Frame& frame);

 private:
  /// The people that the network found, and the image in which it did.
  struct Standing {
    Detection found;
    ImageCells cells;
  };

  std::optional<people::PersonSize> size_at(double x, double y) const;
  std::vector<cv::Rect> tiles_of(cv::Size image) const;
  std::vector<Detection> people_in(const Frame& frame, std::span<const cv::Rect> tiles);
  void learn(std::span<const Detection> found, cv::Size image);
  std::vector<Detection> search(const Frame& frame, const ImageCells& cells, std::span<const Expected> expected,
                                std::span<const Detection> moving);
  std::vector<Box> requested(const ImageCells& cells, std::span<const Expected> expected, std::span<const Detection> moving,
                             cv::Size image) const;
  bool stands(const Box& box) const;
  void forget_changed(const ImageCells& cells);
  std::vector<Detection> standing() const;
  std::vector<Detection> joined(const std::vector<Detection>& moving, const std::vector<Detection>& detected) const;

  NetworkDetectorOptions options_;
  LoadedNetwork network_;
  std::unique_ptr<people::PeopleDetector> moving_;  // none without a background model
  people::PersonSizeModel sizes_;
  std::optional<Timestamp> last_everywhere_;
  double until_everywhere_;         // s from then on
  std::vector<Standing> standing_;  // those found last, as long as their pixels are the same
  ImageCells before_;               // of the last frame that was searched
  std::int64_t frames_ = 0, misfits_ = 0, tiles_ = 0;
};

}  // namespace marey::detect::network
