#include "marey/detect/people/people_grid.h"

#include <array>
#include <cmath>

namespace marey::detect::people {
namespace {

// A body hides what is a little beyond its head and sides.
constexpr std::array<BodyPart, 2> kExplained = {{{0.15, -0.08, 0.85, 0.12}, {-0.03, 0.12, 1.03, 1.03}}};

}  // namespace

PeopleGrid::PeopleGrid(const Box& location, const FitScene& scene, double cell)
    : cell_(cell), per_cell_(1 / cell), left_(location.left), top_(location.top) {
  columns_ = std::max(1, static_cast<int>(std::ceil(location.width / cell)));
  rows_ = std::max(1, static_cast<int>(std::ceil(location.height / cell)));
  filled_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  valid_.resize(filled_.size());
  std::vector<int> wide(columns_);
  for (int column = 0; column < columns_; ++column) wide[column] = overlap(left_ + column * cell_, scene.image.width);
  for (int row = 0; row < rows_; ++row) {
    const int tall = overlap(top_ + row * cell_, scene.image.height);
    for (int column = 0; column < columns_; ++column) valid_[index(row, column)] = tall * wide[column];
  }
  sums_.resize(static_cast<std::size_t>(columns_ + 1) * (rows_ + 1));
}

void PeopleGrid::fill(std::span<const PixelRun> runs, const FitScene& scene) {
  for (const PixelRun& run : runs) {
    const int row = static_cast<int>((run.row - top_) / cell_);
    for (int x = run.begin; x < run.end;) {
      const int column = static_cast<int>((x - left_) / cell_);
      const int end = std::min(run.end, static_cast<int>(left_ + (column + 1) * cell_));
      filled_[index(row, column)] += end - x;
      x = end;
    }
  }
  if (scene.hidden) exclude_hidden(scene);
  first_filled_ = filled_;
  first_valid_ = valid_;
  sum();
}

void PeopleGrid::reset() {
  filled_ = first_filled_;
  valid_ = first_valid_;
  changed_row_ = 0;
}

void PeopleGrid::explain(const Box& box) {
  for (const BodyPart& part : kExplained) {
    const Cells cells = cells_of(box, part);
    changed_row_ = std::min(changed_row_, cells.top);
    for (int row = cells.top; row < cells.bottom; ++row) {
      std::fill(filled_.begin() + index(row, cells.left), filled_.begin() + index(row, cells.right), 0);
      std::fill(valid_.begin() + index(row, cells.left), valid_.begin() + index(row, cells.right), 0);
    }
  }
}

void PeopleGrid::sum() {
  const std::size_t stride = columns_ + 1;
  for (int row = changed_row_; row < rows_; ++row) {
    Count along;
    const std::size_t first = index(row, 0);
    const Count* above = &sums_[row * stride + 1];
    Count* here = &sums_[(row + 1) * stride + 1];
    for (int column = 0; column < columns_; ++column) {
      along += {filled_[first + column], valid_[first + column], first_valid_[first + column]};
      Count sum = above[column];
      sum += along;
      here[column] = sum;
    }
  }
  changed_row_ = rows_;
}

/// How many whole pixels of a cell that begins at `from` lie within an image `size` long.
int PeopleGrid::overlap(double from, int size) const {
  return static_cast<int>(std::max(0.0, std::min(from + cell_, static_cast<double>(size)) - std::max(from, 0.0)));
}

void PeopleGrid::exclude_hidden(const FitScene& scene) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const std::size_t i = index(row, column);
      if (filled_[i] == 0 && scene.hidden(left_ + (column + 0.5) * cell_, top_ + (row + 0.5) * cell_)) valid_[i] = 0;
    }
  }
}

}  // namespace marey::detect::people
