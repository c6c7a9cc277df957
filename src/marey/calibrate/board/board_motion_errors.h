#pragma once

#include <array>
#include <vector>

#include "marey/calibrate/board/pose_spline.h"
#include "marey/calibrate/bundle/bundle_residual.h"

// What fit_board_motion minimises, as Ceres's functors.
namespace marey::calibrate::board {

struct ObservedCorner {
  int id = 0;
  Vector<3> location = Vector<3>::Zero();  // on the board, m
  Vector<2> pixel = Vector<2>::Zero();
  double row = 0;  // share of the image's height from its middle: -0.5 at the top, 0.5 at the bottom
  bool inlier = true;
};

/// A view's errors, predicted minus seen. Blocks: four control poses, the camera's pose, its lens, its offset and readout.
template <typename Model>
struct ViewError {
  std::vector<ObservedCorner> corners;
  double time_s = 0;  // by the camera's clock, less the segment's begin
  double knot_s = 0;

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, const T* d, const T* pose, const T* lens, const T* timing, const T* jitter,
                  T* errors) const {
    const T middle = (T(time_s) + timing[0] + jitter[0]) / T(knot_s), half = timing[1] / T(2 * knot_s);
    const SplinePose<T> top = spline_pose(a, b, c, d, T(middle - half));
    const SplinePose<T> bottom = spline_pose(a, b, c, d, T(middle + half));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const ObservedCorner& corner = corners[i];
      const Eigen::Matrix<T, 3, 1> location = corner.location.template cast<T>();
      const T fraction(0.5 + corner.row);
      const Eigen::Matrix<T, 3, 1> world = (T(1) - fraction) * (top * location) + fraction * (bottom * location);
      Eigen::Matrix<T, 3, 1> in_camera;
      ceres::AngleAxisRotatePoint(pose, world.data(), in_camera.data());
      for (int k = 0; k < 3; ++k) in_camera[k] += pose[3 + k];
      if (!(in_camera.z() > T(1e-6))) return false;
      const Eigen::Matrix<T, 2, 1> at = Model::distort(in_camera, lens + bundle::kLensBase);
      errors[2 * i] = lens[2] + lens[0] * at.x() - T(corner.pixel.x());
      errors[2 * i + 1] = lens[3] + lens[0] * lens[1] * at.y() - T(corner.pixel.y());
    }
    return true;
  }
};

/// An image's own error of time, in standard deviations.
struct Jitter {
  double weight = 1;  // 1/s

  template <typename T>
  bool operator()(const T* jitter, T* error) const {
    error[0] = jitter[0] * T(weight);
    return true;
  }
};

/// Second differences of three neighbouring control poses, in what a hand does in that time.
struct Smoothness {
  double metres = 1, radians = 1;

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* errors) const {
    const std::array<T, 3> before = rotation_between(a, b), after = rotation_between(b, c);
    for (int k = 0; k < 3; ++k) {
      errors[k] = (after[static_cast<std::size_t>(k)] - before[static_cast<std::size_t>(k)]) / T(radians);
      errors[3 + k] = (a[4 + k] - T(2) * b[4 + k] + c[4 + k]) / T(metres);
    }
    return true;
  }
};

}  // namespace marey::calibrate::board
