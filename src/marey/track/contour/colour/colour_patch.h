#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/track/contour/colour/scene_image.h"

namespace marey::track::contour::colour {

/// A piece of an image in cells of `step` × `step` px, ready for sums: what outlines are found in.
struct ColourPatch {
  cv::Point corner;  ///< px of the first cell's top left pixel; even
  int step = 1;      ///< 1, 2 or 4 px
  cv::Mat colour;    ///< CV_32FC3: luma, Cb, Cr in levels; Cb = Cr = 128 where the image is grey
  cv::Mat mask;      ///< CV_32FC1: share of the cell that is foreground, 0 … 1
  cv::Mat scene;     ///< CV_32FC3: the scene without targets, in the same levels; empty if it is not known
  cv::Mat known;     ///< CV_32FC1: share of the cell in which it is, 0 … 1; empty likewise

  cv::Size size() const { return colour.size(); }
  /// px of a place in cells, and vice versa; (0, 0) is the first cell's centre.
  Vector<2> pixel(const Vector<2>& cell) const {
    return Vector<2>(corner.x, corner.y) + step * cell + Vector<2>::Constant((step - 1) / 2.0);
  }
  Vector<2> cell(const Vector<2>& pixel) const {
    return (pixel - Vector<2>(corner.x, corner.y) - Vector<2>::Constant((step - 1) / 2.0)) / step;
  }
};

/// The size of a patch's cells for a target of that height, px.
int cell_step(double height);

/// The box and `by` px more on every side.
inline Box grown(const Box& box, double by) {
  return {box.left - by, box.top - by, box.width + 2 * by, box.height + 2 * by};
}

/// The part of the image (8 bits) within `box`, px; empty if they do not meet. `mask` is CV_8UC1, of the image's size.
/// `scene`, if given and of that size too, is cut along, and chroma is moved to where its luma is.
ColourPatch cut_patch(const Image& image, const cv::Mat& mask, const Box& box, int step, const SceneImage* scene = nullptr);

/// The cells whose centre lies within a polygon (px, even-odd): CV_32FC1, 1 or 0, of the patch's size.
cv::Mat cells_within(std::span<const Vector<2>> polygon, const ColourPatch& patch);

/// The closed curve (px, clockwise on the screen) along which `share` (CV_32FC1, of the patch's size) passes one half: the one that
/// holds the largest area. Beyond the patch nothing is covered. Empty if there is no area.
std::vector<Vector<2>> half_level_curve(const cv::Mat& fraction, const ColourPatch& patch);

}  // namespace marey::track::contour::colour
