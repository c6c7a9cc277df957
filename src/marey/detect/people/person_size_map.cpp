#include "marey/detect/people/person_size_map.h"

#include <array>
#include <cmath>

namespace marey::detect::people {
namespace {

constexpr double kStep = 16;     // px between places of the grid
constexpr double kBeyond = 0.3;  // of the image's width, to each side

}  // namespace

PersonSizeMap::PersonSizeMap(cv::Size image, const std::function<std::optional<PersonSize>(double, double)>& size_at) {
  const double beyond = std::ceil(kBeyond * image.width / kStep) * kStep;
  left_ = top_ = -beyond;
  columns_ = static_cast<int>(std::ceil((image.width + 2 * beyond) / kStep)) + 1;
  rows_ = static_cast<int>(std::ceil((image.height + 2 * beyond) / kStep)) + 1;
  cells_.reserve(static_cast<std::size_t>(columns_) * rows_);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column)
      cells_.push_back(size_at(left_ + column * kStep, top_ + row * kStep).value_or(PersonSize{}));
  }
}

std::optional<PersonSize> PersonSizeMap::at(double x, double y) const {
  const double across = (x - left_) / kStep, down = (y - top_) / kStep;
  if (!(across >= 0 && down >= 0 && across < columns_ - 1 && down < rows_ - 1)) return std::nullopt;
  const int column = static_cast<int>(across), row = static_cast<int>(down);
  const double a = across - column, b = down - row;
  const std::array<double, 4> fractions{(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
  const std::size_t first = static_cast<std::size_t>(row) * columns_ + column;
  const std::array<const PersonSize*, 4> corners{&cells_[first], &cells_[first + 1], &cells_[first + columns_],
                                                 &cells_[first + columns_ + 1]};
  PersonSize sum;
  double known = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!(corners[i]->height > 0)) continue;
    known += fractions[i];
    sum.height += fractions[i] * corners[i]->height;
    sum.width += fractions[i] * corners[i]->width;
  }
  if (known < 0.5) return std::nullopt;
  return PersonSize{sum.height / known, sum.width / known};
}

}  // namespace marey::detect::people
