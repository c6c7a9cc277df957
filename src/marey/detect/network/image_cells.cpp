#include "marey/detect/network/image_cells.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::detect::network {
namespace {

constexpr int kCells = 72;         // along the shorter side
constexpr int kMinCell = 4;        // px
constexpr double kDifference = 8;  // grey levels

bool comparable(const ImageCells& before, const ImageCells& now) {
  return !before.empty() && before.side == now.side && before.luma.size() == now.luma.size();
}

cv::Rect cells_in(const Box& box, const ImageCells& cells) {
  const auto begin = [&](double px) { return static_cast<int>(std::floor(px / cells.side)); };
  const auto end = [&](double px) { return static_cast<int>(std::ceil(px / cells.side)); };
  return cv::Rect(cv::Point(begin(box.left), begin(box.top)), cv::Point(end(box.right()), end(box.bottom()))) &
         cv::Rect({}, cells.luma.size());
}

cv::Mat differences(const cv::Mat& before, const cv::Mat& now) {
  cv::Mat apart;
  cv::absdiff(before, now, apart);
  return apart > kDifference;
}

}  // namespace

ImageCells cells_of(const Image& image) {
  ImageCells cells;
  const cv::Size size = image.size();
  cells.side = std::max(kMinCell, std::min(size.width, size.height) / kCells);
  cv::Mat luma = image.luma();
  if (luma.depth() == CV_16U) luma.convertTo(luma, CV_8U, 1 / 257.0);
  const cv::Size grid(std::max(1, size.width / cells.side), std::max(1, size.height / cells.side));
  cv::resize(luma, cells.luma, grid, 0, 0, cv::INTER_AREA);
  return cells;
}

bool is_unchanged(const ImageCells& before, const ImageCells& now, const Box& box) {
  if (!comparable(before, now)) return false;
  const cv::Rect part = cells_in(box, now);
  return part.area() > 0 && cv::countNonZero(differences(before.luma(part), now.luma(part))) == 0;
}

std::vector<Box> changed_parts(const ImageCells& before, const ImageCells& now, std::span<const Box> explained) {
  const double side = now.side;
  if (!comparable(before, now)) return {{0, 0, now.luma.cols * side, now.luma.rows * side}};
  cv::Mat changed = differences(before.luma, now.luma);
  for (const Box& box : explained) {
    const cv::Rect part = cells_in(box, now);
    if (part.area() > 0) changed(part) = cv::Scalar(0);
  }
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(changed, labels, stats, centres, 8);
  std::vector<Box> parts;
  for (int i = 1; i < count; ++i) {
    const int* stat = stats.ptr<int>(i);
    parts.push_back({stat[cv::CC_STAT_LEFT] * side, stat[cv::CC_STAT_TOP] * side, stat[cv::CC_STAT_WIDTH] * side,
                     stat[cv::CC_STAT_HEIGHT] * side});
  }
  return parts;
}

}  // namespace marey::detect::network
