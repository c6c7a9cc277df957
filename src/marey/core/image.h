#pragma once

#include <memory>

#include <opencv2/core.hpp>

namespace marey {

/// The pixels of one frame: shared and immutable, cheap to copy. Luma at full size and, for colour, two chroma planes at half
/// size (4:2:0), as video is stored: no step pays for a colour conversion that it does not need.
class Image {
 public:
  /// How luma's black and white are coded: video's 16–235 or a photograph's 0–255.
  enum class Range { limited, full };

  Image() = default;

  /// Grey: one CV_8UC1 or CV_16UC1 plane.
  explicit Image(cv::Mat luma) : luma_(std::move(luma)), range_(Range::full) {}

  /// Colour: luma w × h, chroma ⌈w/2⌉ × ⌈h/2⌉, all CV_8UC1, BT.601. `owner` keeps borrowed memory alive (a decoder's frame).
  Image(cv::Mat luma, cv::Mat cb, cv::Mat cr, Range range, std::shared_ptr<const void> owner = nullptr)
      : luma_(std::move(luma)), cb_(std::move(cb)), cr_(std::move(cr)), range_(range), owner_(std::move(owner)) {}

  /// From CV_8UC3, blue first, as OpenCV reads images.
  static Image from_bgr(const cv::Mat& bgr);

  /// A new CV_8UC3 image, blue first; 16-bit grey is scaled so that 65535 becomes 255.
  cv::Mat bgr() const;

  /// The part within `region`, which lies within the image; it shares the pixels where `region` begins on even ones.
  Image part(const cv::Rect& region) const;

  bool empty() const { return luma_.empty(); }
  bool is_colour() const { return !cb_.empty(); }
  cv::Size size() const { return luma_.size(); }
  const cv::Mat& luma() const { return luma_; }
  const cv::Mat& cb() const { return cb_; }
  const cv::Mat& cr() const { return cr_; }
  Range range() const { return range_; }

 private:
  cv::Mat luma_, cb_, cr_;
  Range range_ = Range::full;
  std::shared_ptr<const void> owner_;
};

}  // namespace marey
