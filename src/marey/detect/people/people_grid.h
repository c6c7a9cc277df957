#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "marey/detect/people/people_fit.h"

namespace marey::detect::people {

/// A part of the body, in fractions of its box.
struct BodyPart {
  double left, top, right, bottom;
};

/// Foreground on a coarse grid, with sums over rectangles from an integral image: how much of a part of a body at any place is
/// foreground that no person explains yet. `explain` takes a person's pixels out, so that they count neither for nor against.
class PeopleGrid {
 public:
  /// Covers `place` (px, may reach beyond the image) with square cells of `cell` px; all of it empty.
  PeopleGrid(const Box& location, const FitScene& scene, double cell);

  /// Enters the foreground, once. `runs` lie within `place`.
  void fill(std::span<const PixelRun> runs, const FitScene& scene);

  /// As it was after `fill`; `sum` must follow.
  void reset();

  /// The pixels of the body in `box` count neither for nor against from now on; `sum` must follow.
  void explain(const Box& box);

  struct alignas(16) Count {
    int filled = 0, valid = 0;  ///< px² not explained
    int visible = 0;            ///< px² valid before any person was placed
    int unused = 0;             ///< makes four, which a machine adds at once

    Count& operator+=(const Count& other) {
      filled += other.filled;
      valid += other.valid;
      visible += other.visible;
      unused += other.unused;
      return *this;
    }
    Count& operator-=(const Count& other) {
      filled -= other.filled;
      valid -= other.valid;
      visible -= other.visible;
      unused -= other.unused;
      return *this;
    }
  };

  /// Makes the integral image of the counts as they stand, from the first row on that has changed.
  void sum();

  /// Of `part` of the body in `box`, to the nearest cell.
  Count count(const Box& box, const BodyPart& part) const {
    const Cells c = cells_of(box, part);
    const std::size_t stride = columns_ + 1;
    Count result = sums_[c.bottom * stride + c.right];
    result -= sums_[c.top * stride + c.right];
    result -= sums_[c.bottom * stride + c.left];
    result += sums_[c.top * stride + c.left];
    return result;
  }

  int filled_in_all() const { return sums_.back().filled; }
  double cell() const { return cell_; }
  double left() const { return left_; }
  double top() const { return top_; }
  double right() const { return left_ + columns_ * cell_; }
  double bottom() const { return top_ + rows_ * cell_; }

 private:
  struct Cells {
    int left, top, right, bottom;
  };

  std::size_t index(int row, int column) const { return static_cast<std::size_t>(row) * columns_ + column; }

  int overlap(double from, int size) const;
  void exclude_hidden(const FitScene& scene);

  Cells cells_of(const Box& box, const BodyPart& part) const {
    const auto across = [&](double x) {
      return static_cast<int>(std::clamp((box.left + x * box.width - left_) * per_cell_ + 0.5, 0.0, double(columns_)));
    };
    const auto down = [&](double y) {
      return static_cast<int>(std::clamp((box.top + y * box.height - top_) * per_cell_ + 0.5, 0.0, double(rows_)));
    };
    return {across(part.left), down(part.top), across(part.right), down(part.bottom)};
  }

  double cell_, per_cell_;
  double left_, top_;
  int columns_ = 0, rows_ = 0;
  std::vector<int> filled_, valid_;              ///< px² of each cell that are foreground; that may be: both unexplained
  std::vector<int> first_filled_, first_valid_;  ///< the same before any person was placed
  std::vector<Count> sums_;                      ///< integral image
  int changed_row_ = 0;                          ///< from which row on it is out of date
};

}  // namespace marey::detect::people
