#include "marey/core/image.h"

#include <opencv2/imgproc.hpp>

namespace marey {
namespace {

// BT.601: limited = full * scale + offset, for luma (16..235) and chroma (16..240, centred on 128).
constexpr double kLumaScale = 219.0 / 255.0;
constexpr double kLumaOffset = 16.0;
constexpr double kChromaScale = 224.0 / 255.0;
constexpr double kChromaOffset = 128.0 * (1.0 - kChromaScale);

/// A plane of an I420 image, which OpenCV wants with even sides: the last row and column are repeated where needed.
void put_plane(const cv::Mat& plane, cv::Mat target, double scale, double offset) {
  cv::Mat padded = plane;
  if (plane.size() != target.size()) {
    cv::copyMakeBorder(plane, padded, 0, target.rows - plane.rows, 0, target.cols - plane.cols, cv::BORDER_REPLICATE);
  }
  padded.convertTo(target, CV_8U, scale, offset);
}

}  // namespace

Image Image::from_bgr(const cv::Mat& bgr) {
  CV_Assert(bgr.type() == CV_8UC3 && !bgr.empty());
  cv::Mat even = bgr;
  if (bgr.rows % 2 != 0 || bgr.cols % 2 != 0) {
    cv::copyMakeBorder(bgr, even, 0, bgr.rows % 2, 0, bgr.cols % 2, cv::BORDER_REPLICATE);
  }
  cv::Mat i420;
  cv::cvtColor(even, i420, cv::COLOR_BGR2YUV_I420);
  const cv::Size half(even.cols / 2, even.rows / 2);
  const std::size_t luma_bytes = static_cast<std::size_t>(even.cols) * even.rows;
  unsigned char* planes = i420.data;
  auto owner = std::make_shared<cv::Mat>(i420);
  return {cv::Mat(even.size(), CV_8UC1, planes)(cv::Rect(0, 0, bgr.cols, bgr.rows)), cv::Mat(half, CV_8UC1, planes + luma_bytes),
          cv::Mat(half, CV_8UC1, planes + luma_bytes + half.area()), Range::limited, owner};
}

cv::Mat Image::bgr() const {
  cv::Mat result;
  if (!is_colour()) {
    cv::Mat grey = luma_;
    if (luma_.depth() == CV_16U) luma_.convertTo(grey, CV_8U, 1.0 / 257.0);
    cv::cvtColor(grey, result, cv::COLOR_GRAY2BGR);
    return result;
  }
  const bool full = range_ == Range::full;
  const cv::Size half = cb_.size();
  const cv::Size even(half.width * 2, half.height * 2);
  cv::Mat i420(even.height * 3 / 2, even.width, CV_8UC1);
  unsigned char* planes = i420.data;
  const std::size_t luma_bytes = static_cast<std::size_t>(even.width) * even.height;
  put_plane(luma_, cv::Mat(even, CV_8UC1, planes), full ? kLumaScale : 1, full ? kLumaOffset : 0);
  put_plane(cb_, cv::Mat(half, CV_8UC1, planes + luma_bytes), full ? kChromaScale : 1, full ? kChromaOffset : 0);
  put_plane(cr_, cv::Mat(half, CV_8UC1, planes + luma_bytes + half.area()), full ? kChromaScale : 1, full ? kChromaOffset : 0);
  cv::cvtColor(i420, result, cv::COLOR_YUV2BGR_I420);
  return result.size() == luma_.size() ? result : result(cv::Rect(0, 0, luma_.cols, luma_.rows)).clone();
}

/// Chroma is stored at half size: a region that begins on an odd pixel is cut from the colours themselves.
Image Image::part(const cv::Rect& region) const {
  if (!is_colour()) return Image(luma_(region));
  if (region.x % 2 != 0 || region.y % 2 != 0) return from_bgr(bgr()(region));
  const cv::Rect half(region.x / 2, region.y / 2, (region.width + 1) / 2, (region.height + 1) / 2);
  return {luma_(region), cb_(half), cr_(half), range_, std::make_shared<Image>(*this)};
}

}  // namespace marey
