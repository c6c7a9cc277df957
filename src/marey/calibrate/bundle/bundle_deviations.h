#pragma once

#include <vector>

#include "marey/calibrate/bundle/bundle.h"

namespace marey::calibrate::bundle {

/// Standard deviation known beforehand of each of a lens's numbers, in the order and the units of `numbers_of(lens)`; 0: held.
std::vector<double> lens_sigmas(const geometry::Lens& start, const LensFreedom& freedom);

/// Derivatives of a camera's centre in the world by the numbers of its pose (angle-axis and translation of camera_from_world).
Eigen::Matrix<double, 3, 6> centre_by_pose(const Rigid3& camera_from_world);

/// How many numbers the inliers decide.
int free_numbers(const Bundle& bundle, const std::vector<char>& inlier);

/// Standard deviations of the cameras' numbers: the bodies are eliminated (Schur complement), the rest is inverted, directions
/// that nothing decides (the scale of free points) omitted. `noise_px` of an observation's axis.
std::vector<CameraDeviation> deviations_of(const Bundle& bundle, const std::vector<BundleCamera>& start,
                                           const std::vector<char>& inlier, double noise_px);

}  // namespace marey::calibrate::bundle
