#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_levels.h"
#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// Levels of the pixels along the border of a frame, grey levels.
struct RimLevels {
  double middle = 0;  ///< their median
  double upper = 0;   ///< what 70 % of them do not pass, towards the markers' side
};

/// Of the border of `frame`; nothing where all of it lies outside the picture.
std::optional<RimLevels> rim_levels(const cv::Mat& image, const cv::Rect& frame, bool dark);

/// How far a blob's pixels stand out from the rim 2 px beyond its box, whatever the tile's background is, grey levels.
double height_over_rim(const cv::Mat& image, const MarkerBlob& blob, bool dark);

/// How far the blobs of one frame stand out, the bright ones deciding; nothing where there are none. `background` of their tiles.
std::optional<double> bright_contrast(const cv::Mat& image, std::span<const MarkerBlob> blobs, const MarkerLevels& levels,
                                      bool dark);

/// Blobs within regions that pass the threshold as a whole and are no markers: a grey bar, the glow of a lamp, the bright end of a
/// gradient. A region is searched again above its own median, and what is found there and is too large again, until nothing is.
class InnerBlobFinder {
 public:
  InnerBlobFinder();

  /// Appends to `blobs` what lies within those of its first `blobs.size()` that `is_region` tells, with the runs that they were
  /// found by. `least`: by how much a pixel must pass a region's median. Bounded: pixels of twice the picture a frame.
  template <typename IsRegion>
  void find(const cv::Mat& image, const MarkerRunFinder& finder, double least, bool dark, std::vector<MarkerBlob>& blobs,
            IsRegion&& is_region) {
    pixels_left_ = 2 * static_cast<std::int64_t>(image.total());
    regions_.clear();
    for (std::size_t i = 0; i < blobs.size(); ++i) {
      if (is_region(blobs[i])) regions_.push_back(i);
    }
    if (regions_.empty()) return;
    begin(image, finder, blobs);
    for (std::size_t next = 0; next < pieces_.size() && pixels_left_ > 0; ++next) {
      search(next, least, dark);
      for (std::size_t i = 0; i < found_.size(); ++i) {
        if (is_region(found_[i])) {
          add_piece(next, i);
        } else {
          blobs.push_back(moved(found_[i], pieces_[next].corner));
        }
      }
    }
  }

 private:
  /// A region's own pixels; the others hold its median.
  struct Piece {
    cv::Point corner;
    cv::Mat pixels;
    cv::Mat own;  ///< CV_8UC1: which are its own
    double median = 0;
  };

  static MarkerBlob moved(MarkerBlob blob, const cv::Point& by);
  void begin(const cv::Mat& image, const MarkerRunFinder& finder, std::span<const MarkerBlob> blobs);
  void search(std::size_t piece, double least, bool dark);
  void add_piece(std::size_t parent, std::size_t found);
  void finish(Piece piece);

  MarkerRunFinder finder_;
  std::vector<std::size_t> regions_;
  std::vector<Piece> pieces_;
  std::vector<MarkerBlob> found_;
  std::vector<MarkerRun> runs_;
  std::int64_t pixels_left_ = 0;
};

}  // namespace marey::detect::markers
