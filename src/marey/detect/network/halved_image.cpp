#include "marey/detect/network/halved_image.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace marey::detect::network {
namespace {

/// The last pixels are repeated where the plane has fewer than twice `half`.
cv::Mat half_of(const cv::Mat& plane, cv::Size half) {
  cv::Mat whole = plane;
  const int right = 2 * half.width - plane.cols, bottom = 2 * half.height - plane.rows;
  if (right > 0 || bottom > 0)
    cv::copyMakeBorder(plane, whole, 0, std::max(0, bottom), 0, std::max(0, right), cv::BORDER_REPLICATE);
  cv::Mat result;
  cv::resize(whole(cv::Rect(cv::Point(), half * 2)), result, half, 0, 0, cv::INTER_AREA);
  return result;
}

}  // namespace

Image halved(const Image& image) {
  const cv::Size size(image.size().width / 2, image.size().height / 2);
  if (size.width < 1 || size.height < 1) return image;
  const cv::Mat luma = half_of(image.luma(), size);
  if (!image.is_colour()) return Image(luma);
  const cv::Size chroma((size.width + 1) / 2, (size.height + 1) / 2);
  return {luma, half_of(image.cb(), chroma), half_of(image.cr(), chroma), image.range()};
}

}  // namespace marey::detect::network
