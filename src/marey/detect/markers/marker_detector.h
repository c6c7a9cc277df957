#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/detect/detector.h"
#include "marey/detect/markers/marker_options.h"

namespace marey::detect::markers {

/// What happened to the blobs so far, for the run's summary.
struct MarkerCounts {
  std::int64_t frames = 0;
  std::int64_t markers = 0;     ///< reported
  std::int64_t too_small = 0;   ///< below min_area
  std::int64_t faint = 0;       ///< stand out from a tile's ground, but not as markers do from what is close by: noise, texture
  std::int64_t too_large = 0;   ///< above max_area
  std::int64_t not_round = 0;   ///< below min_roundness
  std::int64_t unlike = 0;      ///< no disc, no several, no streak, and larger than the markers that are seen: a lamp, a reflection
  std::int64_t over_limit = 0;  ///< more than max_markers in their frame
  std::int64_t split = 0;       ///< blobs that were taken apart
  std::int64_t not_fitted = 0;  ///< reported with the weighted centroid, because no disc fitted
  std::int64_t frames_cut = 0;  ///< frames with this much above the threshold that their lower part was not searched
  double masked_fraction = 0;   ///< of the image, by both masks
};

/// One sentence each on what was omitted; empty if nothing was.
std::vector<std::string> warnings(const MarkerCounts& counts);

/// Finds markers: bright, dark or coloured spots, as sub-pixel points with their covariance. Frames are of one camera.
/// Throws Error if a colour is asked of a grey image or the mask is not of the image's size.
class MarkerDetector final : public Detector {
 public:
  explicit MarkerDetector(const MarkerOptions& options = {});
  ~MarkerDetector() override;

  /// Learns the automatic mask at once where the samples lie within its time.
  void prime(std::span<const Frame> samples) override;

  /// Searches by other options from the next frame on. The model of the image is learned again; the counts continue.
  void change(const MarkerOptions& options);
  /// Once the automatic mask is learned: the boxes of its parts, px, from top to bottom.
  std::optional<std::vector<cv::Rect>> learned_parts() const;

  /// Markers in the order of their first pixel. `expected` decides which stay when there are too many, and where to search for two
  /// in one blob.
  Detections detect(const Frame& frame, std::span<const Expected> expected) override;

  /// Noise are the blobs too small, misfits those too large, not round or unlike the others.
  DetectionCounts detection_counts() const override;

  const MarkerCounts& counts() const;
  std::vector<std::string> warnings() const override { return markers::warnings(counts()); }
  /// The contrast that a pixel must have to pass and the pixels' noise, grey levels, as of the last frame; for the summary.
  double typical_threshold() const;
  double noise() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::detect::markers
