#pragma once

#include <vector>

#include <ceres/cost_function.h>

#include "marey/calibrate/bundle/bundle.h"

// The pieces of the bundle that Ceres sees. Blocks of numbers:
//   pose   angle-axis 3, translation 3 of camera_from_world
//   lens   focal of x, focal ratio y/x, principal 2, distortion coefficients
//   offset 1
//   body   point 3 | wand: origin 3, direction 3 | board: angle-axis 3, translation 3

namespace marey::calibrate::bundle {

inline constexpr int kPose = 6;
inline constexpr int kLensBase = 4;

int lens_numbers(const geometry::Lens& lens);
int body_numbers(const Body& body);

std::vector<double> numbers_of(const Rigid3& pose);
std::vector<double> numbers_of(const geometry::Lens& lens);
std::vector<double> numbers_of(const Body& body);
Rigid3 pose_from(const double* numbers);
void set_numbers(geometry::Lens& lens, const double* numbers);
void set_numbers(Body& body, const double* numbers);

/// The rotation group's left Jacobian J: ∂(exp(w)·v)/∂w = -[exp(w)·v]× · J(w).
Matrix<3> left_jacobian(const Vector<3>& angle_axis);

/// One observation's error, predicted minus seen, 2 numbers in px, with analytic derivatives; only the lens's own are automatic.
/// Blocks: pose, lens, body and, where `with_offset`, the offset. Evaluating fails where the marker is behind the camera.
/// `site` is the marker's place on its body: (distance, 0, 0) on a wand, the point on a board. The result is Ceres's to delete.
ceres::CostFunction* make_reprojection(const geometry::Lens& lens, const Body& body, const Vector<3>& site,
                                       const BundleObservation& detected, bool with_offset);

}  // namespace marey::calibrate::bundle
