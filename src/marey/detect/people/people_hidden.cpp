// An image of small cells, each with two counts: how often a person's body should have covered it, and how often something was
// seen there. Old evidence fades by halving, so that a parked car that leaves is forgotten. Only the inner part of the body
// is counted: the rest of a box is often empty.
// Cost: one reading of the mask for each cell under a body, some hundreds a person.
#include "marey/detect/people/people_hidden.h"

#include <algorithm>

namespace marey::detect::people {
namespace {

constexpr int kMaskCellsAcross = 192;
constexpr std::int32_t kMemory = 120;  // frames with a body, then all is halved
constexpr double kInnerLeft = 0.3, kInnerRight = 0.7, kInnerTop = 0.12, kInnerBottom = 0.9;

}  // namespace

void StaticOccluders::note(const Box& person, const cv::Mat& mask) {
  if (mask.empty()) return;
  if (image_ != mask.size()) {
    image_ = mask.size();
    side_ = std::max(1, image_.width / kMaskCellsAcross);
    columns_ = (image_.width + side_ - 1) / side_;
    cells_.assign(static_cast<std::size_t>(columns_) * ((image_.height + side_ - 1) / side_), {});
  }
  const auto first = [&](double from) { return std::max(0, static_cast<int>(from) / side_); };
  const int right = std::min(image_.width, static_cast<int>(person.left + kInnerRight * person.width));
  const int bottom = std::min(image_.height, static_cast<int>(person.top + kInnerBottom * person.height));
  for (int row = first(person.top + kInnerTop * person.height); row * side_ < bottom; ++row) {
    for (int column = first(person.left + kInnerLeft * person.width); column * side_ < right; ++column) {
      Cell& cell = cells_[static_cast<std::size_t>(row) * columns_ + column];
      const int x = std::min(image_.width - 1, column * side_ + side_ / 2);
      const int y = std::min(image_.height - 1, row * side_ + side_ / 2);
      ++cell.covered;
      cell.detected += mask.at<std::uint8_t>(y, x) != 0;
      if (cell.covered >= kMemory) {
        cell.covered /= 2;
        cell.detected /= 2;
      }
    }
  }
}

}  // namespace marey::detect::people
