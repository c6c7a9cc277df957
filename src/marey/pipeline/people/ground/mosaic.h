// The empty scene of a PTZ camera: a mosaic over pan and tilt, from frames whose aim is known.
//
// A camera on a tripod sees every scene from nearly one place, so that a direction from it always shows the same: the ground, or
// what stands far behind it. The mosaic keeps some values of each direction, evenly chosen over time, and their median is the
// empty scene; people move on. Cost: some 30 ms a frame of 720p to add or to give. Memory: 8 bytes a cell, 12 million cells at
// most.
// Reference: Szeliski, "Image alignment and stitching", 2006 (rotational mosaics); Thomas 2007 (texture of a pitch as seen).
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/ptz_camera.h"

namespace marey::pipeline::people::ground {

class Mosaic {
 public:
  /// As wide as the camera's known aims show, as fine as `cells` allow. `size` of the images, px.
  Mosaic(const PtzCamera& camera, cv::Size size, std::size_t cells = 12'000'000);

  /// An image whose aim is known, CV_8UC1.
  void add(const cv::Mat& luma, const geometry::Heading& heading);
  /// Takes the medians; nothing is added afterwards.
  void finish();

  /// The empty scene as this aim shows it, CV_8UC1; 0 where nothing is known.
  cv::Mat scene(const geometry::Heading& heading) const;

 private:
  Vector<3> shown(double pan, double tilt) const;

  geometry::Tripod tripod_;
  cv::Size size_;
  double pan_ = 0, tilt_ = 0, cell_ = 1;  // rad: of the first column and row, and between cells
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> kept_;   // kKept a cell
  std::vector<std::uint8_t> count_;  // that were seen, at most 255
  std::uint32_t added_ = 0;
  cv::Mat median_;
};

}  // namespace marey::pipeline::people::ground
