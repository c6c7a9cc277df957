// A camera's threshold and masks, which may be changed while its images are searched.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/detect/markers/marker_detector.h"

namespace marey::pipeline::corridor {

/// How markers are searched for in a camera's image: by `options`, where the rig says nothing of its own for it. A threshold in
/// `options` counts for all cameras.
detect::markers::MarkerOptions markers_of(const RigCamera& camera, detect::markers::MarkerOptions options);

/// Takes out what lies in one of the masks.
void exclude_masked(std::vector<Detection>& detections, std::span<const Mask> masks);

/// The requested settings of a camera's detector. From any thread.
class MarkerTuning {
 public:
  static constexpr std::size_t kMaxMasks = 256;
  static constexpr double kLitSeconds = 1;  ///< that what is lit must stay for `mask_lit`

  struct Values {
    std::optional<double> threshold;  ///< grey level; nothing: from the image's noise
    std::vector<Mask> masks;          ///< px of the camera's image
    bool learning = false;            ///< what is lit is being learned, to be masked
    bool operator==(const Values&) const = default;
  };

  explicit MarkerTuning(Values values) : values_(std::move(values)) {}

  Values values() const;
  void set_threshold(std::optional<double> threshold);
  /// Throws Error if there are too many.
  void mask(const Mask& part);
  void unmask(const Mask& part);
  void set_masks(std::vector<Mask> masks);
  /// Masks what stands out and does not move in the second that comes.
  void mask_lit();

  // For the detector.
  /// Grows with each change.
  std::int64_t version() const { return version_; }
  /// Ends the learning: these are masked, as far as there is room.
  void learned(std::span<const cv::Rect> parts);

 private:
  template <typename Change>
  void change(const Change& change);

  mutable std::mutex mutex_;
  Values values_;
  std::atomic<std::int64_t> version_ = 0;
};

/// A marker detector that is tuned while it runs.
class TunedMarkers final : public detect::Detector {
 public:
  /// Without `tuning` it stays as `options` say.
  TunedMarkers(const detect::markers::MarkerOptions& options, std::shared_ptr<MarkerTuning> tuning);

  detect::Detections detect(const Frame& frame, std::span<const Expected> expected) override;
  std::vector<std::string> warnings() const override { return detector_.warnings(); }
  detect::DetectionCounts detection_counts() const override { return detector_.detection_counts(); }

 private:
  void retune();

  detect::markers::MarkerOptions options_;
  std::shared_ptr<MarkerTuning> tuning_;
  std::int64_t version_ = 0;
  bool learning_ = false;
  detect::markers::MarkerDetector detector_;
};

}  // namespace marey::pipeline::corridor
