#pragma once

#include <cmath>
#include <cstddef>

#include "marey/core/geometry.h"
#include "marey/format/motion/c3d_layout.h"
#include "marey/format/motion/c3d_parameters.h"

namespace marey::format::motion {

/// A C3D file's points as they are in the file. Both arguments must outlive it; frames and points count from 0.
class C3dPointWords {
 public:
  C3dPointWords(const C3dBytes& bytes, const C3dLayout& layout) : bytes_(&bytes), layout_(&layout) {}

  const C3dLayout& layout() const { return *layout_; }

  /// The fourth word: its lower byte the residual, its higher one the cameras; negative if the point is missing. 65535 counts as 0:
  /// it is −1 written without a sign, and some programs write it for all points.
  int fourth_word(std::size_t frame, std::size_t point) const {
    const std::size_t at = offset(frame, point);
    if (!layout_->real) return bytes_->integer(at + 6);
    const double value = std::round(bytes_->real(at + 12));
    return value >= 0 && value <= 32767 ? static_cast<int>(value) : value > 32767 ? 0 : -1;
  }

  /// In the file's unit; not finite if the file has it so.
  double coordinate(std::size_t frame, std::size_t point, std::size_t axis) const {
    const std::size_t at = offset(frame, point);
    return layout_->real ? static_cast<double>(bytes_->real(at + 4 * axis)) : bytes_->integer(at + 2 * axis) * layout_->scale;
  }

  /// In the file's unit.
  Vector<3> position(std::size_t frame, std::size_t point) const {
    return {coordinate(frame, point, 0), coordinate(frame, point, 1), coordinate(frame, point, 2)};
  }

 private:
  std::size_t offset(std::size_t frame, std::size_t point) const {
    return layout_->begin + frame * layout_->frame_bytes() + point * 4 * layout_->word();
  }

  const C3dBytes* bytes_;
  const C3dLayout* layout_;
};

}  // namespace marey::format::motion
