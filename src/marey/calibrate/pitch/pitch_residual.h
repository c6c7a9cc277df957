// How far clicks and paint lie from where a camera over a pitch projects them, differentiable in the camera and in the ground.
#pragma once

#include <array>

#include <ceres/rotation.h>
#include <opencv2/core/types.hpp>

#include "marey/calibrate/pitch/pitch_camera.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/ground_surface.h"

namespace marey::calibrate::pitch {

/// A camera with square pixels and Brown's lens as a solver moves it: focal length, principal point 2, distortion 8, angle-axis 3,
/// translation 3; px, m.
struct CameraNumbers {
  enum { focal = 0, principal = 1, distortion = 3, rotation = 11, translation = 14, count = 17 };
  std::array<double, count> p{};

  static CameraNumbers of(const Camera& camera);
  Camera camera(cv::Size size) const;
};

/// The middle of an image, px.
inline Vector<2> middle_of(cv::Size size) {
  return {(size.width - 1) / 2.0, (size.height - 1) / 2.0};
}

/// The pixel of a place of the ground, `height` m above z = 0. What would come to lie behind the camera is held before it, so that
/// every step of the solver has a cost.
template <typename T>
Eigen::Matrix<T, 2, 1> project_ground(const T* p, const Vector<2>& ground, const T& height) {
  constexpr double kMinDistance = 0.5;  // m before the camera
  const T location[3] = {T(ground.x()), T(ground.y()), height};
  Eigen::Matrix<T, 3, 1> at;
  ceres::AngleAxisRotatePoint(p + CameraNumbers::rotation, location, at.data());
  for (int i = 0; i < 3; ++i) at(i) += p[CameraNumbers::translation + i];
  if (!(at.z() > T(kMinDistance))) at.z() = T(kMinDistance);
  const Eigen::Matrix<T, 2, 1> plane = geometry::BrownLens::distort(at, p + CameraNumbers::distortion);
  return {p[CameraNumbers::focal] * plane.x() + p[CameraNumbers::principal],
          p[CameraNumbers::focal] * plane.y() + p[CameraNumbers::principal + 1]};
}

/// Prior knowledge of any lens before anything is seen: its numbers from the principal point to the last coefficient. Deviation 0
/// holds the number.
struct LensPrior {
  CameraNumbers middle, sigma;

  template <typename T>
  bool operator()(const T* p, T* error) const {
    for (int i = CameraNumbers::principal; i < CameraNumbers::rotation; ++i)
      error[i - CameraNumbers::principal] = sigma.p[i] > 0 ? (p[i] - middle.p[i]) / sigma.p[i] : T(0);
    return true;
  }
};

}  // namespace marey::calibrate::pitch
