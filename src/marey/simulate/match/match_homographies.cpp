#include "marey/simulate/match/match_homographies.h"

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "marey/geometry/camera.h"
#include "marey/geometry/decompositions.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {
namespace {

/// A place of the pitch and where a camera sees it.
struct ObservedGround {
  Vector<2> ground, pixel;
};

std::vector<ObservedGround> ground_observed_by(const GroundView& view, const geometry::PitchSize& pitch) {
  std::vector<ObservedGround> detected;
  for (double x = 0; x <= pitch.length; x += 2) {
    for (double y = 0; y <= pitch.width; y += 2) {
      const auto pixel = view.pixel({x, y});
      if (pixel && view.camera()->in_image(*pixel)) detected.push_back({{x, y}, *pixel});
    }
  }
  return detected;
}

/// The homography that takes pixels nearest to places, algebraically.
Matrix<3> fitted(const std::vector<ObservedGround>& detected, const cv::Size& size) {
  Matrix<3> scale = Matrix<3>::Identity();
  scale(0, 0) = scale(1, 1) = 2.0 / size.width;
  scale(0, 2) = scale(1, 2) = -1;
  Matrix<9> sum = Matrix<9>::Zero();
  for (const ObservedGround& one : detected) {
    const Vector<3> p = scale * one.pixel.homogeneous();
    Eigen::Matrix<double, 2, 9> rows;
    rows << p.transpose(), Vector<3>::Zero().transpose(), -one.ground.x() * p.transpose(), Vector<3>::Zero().transpose(),
        p.transpose(), -one.ground.y() * p.transpose();
    sum += rows.transpose() * rows;
  }
  const Vector<9> h = geometry::eigenpairs(sum).vectors.col(0);
  Matrix<3> H;
  H << h.segment<3>(0).transpose(), h.segment<3>(3).transpose(), h.segment<3>(6).transpose();
  return H * scale;
}

double error_of(const Matrix<3>& ground_from_image, const std::vector<ObservedGround>& detected) {
  double sum = 0;
  for (const ObservedGround& one : detected)
    sum += ((ground_from_image * one.pixel.homogeneous()).hnormalized() - one.ground).squaredNorm();
  return std::sqrt(sum / static_cast<double>(detected.size()));
}

/// Off by `wanted` m, root mean square.
Matrix<3> off_by(const std::vector<ObservedGround>& detected, const cv::Size& size, const geometry::PitchSize& pitch,
                 double required, Random& random) {
  std::vector<Vector<2>> terms;
  for (int i = 0; i < 5; ++i) terms.push_back(random.gaussian_pair());
  double strength = required;
  Matrix<3> H;
  for (int turn = 0; turn < 6; ++turn) {
    std::vector<ObservedGround> wrong = detected;
    for (ObservedGround& one : wrong) {
      const double u = 2 * one.ground.x() / pitch.length - 1, v = 2 * one.ground.y() / pitch.width - 1;
      one.ground += strength * (terms[0] + u * terms[1] + v * terms[2] + (u * u - v * v) * terms[3] + u * v * terms[4]);
    }
    H = fitted(wrong, size);
    strength *= std::min(2.0, required / error_of(H, detected));
  }
  return H;
}

}  // namespace

Rig known_by_homographies(const Rig& exact, const geometry::PitchSize& pitch, double minimum, double maximum, std::uint64_t seed) {
  Random random(seed * 7919 + 3);
  Rig rig = exact;
  for (RigCamera& camera : rig.cameras) {
    const Camera truth = camera.camera().value();
    const std::vector<ObservedGround> detected = ground_observed_by(GroundView(truth, rig.ground), pitch);
    camera.ground_from_image = off_by(detected, truth.size(), pitch, random.uniform(minimum, maximum), random);
    camera.lens.reset();
    camera.camera_from_world.reset();
  }
  rig.ground = {};
  return rig;
}

}  // namespace marey::simulate::match
