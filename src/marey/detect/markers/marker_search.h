#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/frame.h"
#include "marey/detect/markers/marker_auto_mask.h"
#include "marey/detect/markers/marker_clutter.h"
#include "marey/detect/markers/marker_contrast.h"
#include "marey/detect/markers/marker_levels.h"
#include "marey/detect/markers/marker_options.h"
#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// Finds what stands out in an image: blobs, and by how much. The automatic threshold is more than one pass over the first
/// image, and at one in which something is new: what markers stand out by, and where the ground is not plain, is known only when
/// blobs were seen. Later images take over the learned values.
class MarkerSearch {
 public:
  explicit MarkerSearch(const MarkerOptions& options);

  /// Learns the automatic mask at once where the samples lie within its time.
  void prime(std::span<const Frame> samples);

  /// Blobs in pixels of the full image, whatever they were found in. `widest`: px, of the largest marker that is known of.
  std::span<const MarkerBlob> find(const Frame& frame, std::optional<double> widest);
  /// Of a blob of the last frame: where the threshold is automatic, whether it is not a noise and no edge of something wide.
  bool stands_out(std::size_t blob) const { return standing_.empty() || standing_[blob] == Standing::out; }
  /// Its light falls off slowly: a lamp's, or of what is out of focus.
  bool has_halo(std::size_t blob) const;
  /// What lies round it, grey levels.
  double around(const cv::Mat& luma, std::size_t blob) const;
  /// The contrast that a pixel must have to pass there, grey levels.
  double min_contrast(const MarkerBlob& blob) { return std::max(1.0, demand(blob, levels_.background(blob.box.x, blob.box.y))); }

  const MarkerLevels& levels() const { return levels_; }
  bool was_cut() const { return finder_.cut_at().has_value(); }  ///< the last frame's lower part was not searched
  double masked_fraction() const { return masked_fraction_; }    ///< of the image
  /// Once the automatic mask is learned: the boxes of its parts, px of the image.
  std::optional<std::vector<cv::Rect>> learned_parts() const;

 private:
  enum class Standing : char {
    unobserved,  ///< too small to be measured
    faint,       ///< as what lies round it, or nearly
    clutter,     ///< as many others do, and markers do not
    out,
  };

  void prepare(const Image& image);
  void begin(cv::Size size);
  void inspect(const Image& image);
  void mask_more(const MarkerMask& learned);
  void assess(const cv::Mat& luma);
  double demand(const MarkerBlob& blob, double around);
  void leave_clutter();
  bool learned_contrast();
  bool found_clutter();
  bool is_structure(const MarkerBlob& blob) const;

  MarkerOptions options_;
  MarkerLevels levels_;
  MarkerClutter clutter_;
  MarkerRunFinder finder_;
  MarkerAutoMask auto_mask_;
  MarkerMask mask_, learned_;  // all that is omitted; of that the automatic mask's
  MarkerThresholds colour_thresholds_;
  cv::Size size_;  // of what is searched
  cv::Mat colours_;
  double masked_fraction_ = 0;
  double widest_ = 0;
  std::int64_t frames_ = 0;
  std::span<const MarkerBlob> blobs_;
  std::vector<MarkerBlob> full_size_;
  std::vector<MarkerContrast> contrasts_;  // of each blob
  std::vector<Standing> standing_;         // likewise
  std::vector<char> structure_;            // likewise
  std::vector<double> heights_;
  std::optional<TypicalMarker> typical_;  // of this frame's blobs
  std::optional<double> typical_area_;    // px², likewise
};

}  // namespace marey::detect::markers
