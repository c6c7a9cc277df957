// What changed in an image: its luma, averaged over square cells, beside that of an earlier image. Noise and compression average
// out within a cell; a person who moves changes some.
#pragma once

#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"

namespace marey::detect::network {

/// The cells of one image. Copies share the values.
struct ImageCells {
  cv::Mat luma;  ///< CV_8UC1, a cell each
  int side = 1;  ///< px

  bool empty() const { return luma.empty(); }
};

ImageCells cells_of(const Image& image);

/// Whether nothing within the box differs; false where the images' sizes do.
bool is_unchanged(const ImageCells& before, const ImageCells& now, const Box& box);

/// The parts, px, in which cells differ and lie in none of `explained`: one box for each set of cells that touch. The whole image
/// if there is no previous one.
std::vector<Box> changed_parts(const ImageCells& before, const ImageCells& now, std::span<const Box> explained);

}  // namespace marey::detect::network
