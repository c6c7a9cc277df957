#include "marey/detect/keypoints/person_region.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/detect/network/halved_image.h"

namespace marey::detect::keypoints {
namespace {

constexpr double kRoom = 1.25;  // a region's side over a person's extent: as the networks were trained
constexpr double kMinSize = 8;  // px; a region's side
constexpr double kCoarse = 2;   // an image that shrinks by more is averaged first, so that no detail turns into noise

/// The part of an image that a region's crop is made of, px.
cv::Rect part_of(const PersonRegion& region, cv::Size image) {
  const double reach = region.side / std::sqrt(2.0) + 2;
  return cv::Rect(cv::Point(static_cast<int>(std::floor(region.centre.x() - reach)),
                            static_cast<int>(std::floor(region.centre.y() - reach))),
                  cv::Point(static_cast<int>(std::ceil(region.centre.x() + reach)),
                            static_cast<int>(std::ceil(region.centre.y() + reach)))) &
         cv::Rect(cv::Point(), image);
}

}  // namespace

Matrix<2> PersonRegion::turn() const {
  const double c = std::cos(angle) * scale(), s = std::sin(angle) * scale();
  Matrix<2> result;
  result << c, -s, s, c;
  return result;
}

Vector<2> PersonRegion::in_image(const Vector<2>& in_crop) const {
  return centre + turn() * (in_crop - Vector<2>::Constant(kCrop / 2.0));
}

PersonRegion region_of(const Box& box) {
  return {.centre = box.centre(), .side = std::max(kMinSize, kRoom * std::max(box.width, box.height)), .angle = 0};
}

PersonRegion region_of(const Vector<2>& hips, const Vector<2>& rim) {
  const Vector<2> up = rim - hips;
  return {.centre = hips, .side = std::max(kMinSize, kRoom * 2 * up.norm()), .angle = std::atan2(up.x(), -up.y())};
}

cv::Mat crop_of(const cv::Mat& bgr, const PersonRegion& region) {
  const cv::Rect part = part_of(region, bgr.size());
  if (part.empty()) return cv::Mat::zeros(PersonRegion::kCrop, PersonRegion::kCrop, CV_8UC3);
  cv::Mat from = bgr(part);
  double shrunk_x = 1, shrunk_y = 1;
  if (region.scale() > kCoarse) {
    const double by = std::floor(region.scale());
    const cv::Size size(std::max(1, static_cast<int>(from.cols / by)), std::max(1, static_cast<int>(from.rows / by)));
    shrunk_x = static_cast<double>(from.cols) / size.width, shrunk_y = static_cast<double>(from.rows) / size.height;
    cv::Mat small;
    cv::resize(from, small, size, 0, 0, cv::INTER_AREA);
    from = small;
  }
  // From a pixel of the crop, whose centre lies half a pixel from its edge, to a pixel of `from`.
  const Matrix<2> turn = region.turn();
  const Vector<2> corner = region.in_image(Vector<2>::Constant(0.5)) - Vector<2>(part.x, part.y);
  const cv::Matx23d map(turn(0, 0) / shrunk_x, turn(0, 1) / shrunk_x, (corner.x() + 0.5) / shrunk_x - 0.5,  //
                        turn(1, 0) / shrunk_y, turn(1, 1) / shrunk_y, (corner.y() + 0.5) / shrunk_y - 0.5);
  cv::Mat crop;
  cv::warpAffine(from, crop, map, {PersonRegion::kCrop, PersonRegion::kCrop}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  return crop;
}

cv::Mat crop_of(const Image& image, const PersonRegion& region) {
  cv::Rect part = part_of(region, image.size());
  if (part.empty()) return cv::Mat::zeros(PersonRegion::kCrop, PersonRegion::kCrop, CV_8UC3);
  // Chroma has half the size: a part that begins at even pixels shares it.
  const cv::Point corner(part.x - part.x % 2, part.y - part.y % 2);
  part = cv::Rect(corner, part.br());
  PersonRegion in_part = region;
  in_part.centre -= Vector<2>(corner.x, corner.y);
  Image from = image.part(part);
  while (in_part.scale() > kCoarse && std::min(from.size().width, from.size().height) > 1) {
    from = network::halved(from);
    in_part.centre = (in_part.centre - Vector<2>::Constant(0.5)) / 2;
    in_part.side /= 2;
  }
  return crop_of(from.bgr(), in_part);
}

}  // namespace marey::detect::keypoints
