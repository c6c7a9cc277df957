// What changed in a picture: its luma, averaged over square cells, beside that of an earlier picture. Noise and compression average
// out within a cell; a person who moves changes some.
#pragma once

#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "marey/core/geometry.h"
#include "marey/core/picture.h"

namespace marey::detect::network {

/// The cells of one picture. Copies share the values.
struct PictureCells {
  cv::Mat luma;  ///< CV_8UC1, a cell each
  int side = 1;  ///< px

  bool empty() const { return luma.empty(); }
};

PictureCells cells_of(const Picture& picture);

/// Whether nothing within the box differs; false where the pictures' sizes do.
bool is_unchanged(const PictureCells& before, const PictureCells& now, const Box& box);

/// The parts, px, in which cells differ and lie in none of `explained`: one box for each set of cells that touch. The whole picture
/// where there is none before.
std::vector<Box> changed_parts(const PictureCells& before, const PictureCells& now, std::span<const Box> explained);

}  // namespace marey::detect::network
