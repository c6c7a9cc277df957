// Least squares on pixels over a grid of 24 × 18 points, by Levenberg and Marquardt's method: 4 numbers of the lens, its
// coefficients, and a small rotation where it is allowed. Derivatives are exact (ceres::Jet). A few milliseconds.
#include "marey/geometry/lens_fit.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <ceres/jet.h>

#include "marey/geometry/rigid.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {
namespace {

constexpr int kParameters = 4 + BrownLens::coefficients + 3;
using Jet = ceres::Jet<double, kParameters>;
using Parameters = Eigen::Matrix<double, kParameters, 1>;

struct Sight {
  Vector<2> pixel;
  Vector<3> direction;
};

struct Trial {
  BrownLens lens;
  Matrix<3> turn = Matrix<3>::Identity();

  /// Steps of the lens add up; the rotation's is one from where it stands.
  Trial stepped(const Parameters& step) const {
    Trial next = *this;
    next.lens.focal += step.segment<2>(0);
    next.lens.principal += step.segment<2>(2);
    for (std::size_t i = 0; i < BrownLens::coefficients; ++i) next.lens.distortion[i] += step[4 + static_cast<int>(i)];
    next.turn = rotation_from(step.tail<3>()) * turn;
    return next;
  }

  Eigen::Matrix<Jet, 2, 1> pixel(const Vector<3>& direction) const {
    const Vector<3> d = turn * direction;
    constexpr int kTurn = 4 + BrownLens::coefficients;
    Eigen::Matrix<Jet, 3, 1> at(Jet(d.x()), Jet(d.y()), Jet(d.z()));
    at.x().v[kTurn + 1] = d.z(), at.x().v[kTurn + 2] = -d.y();
    at.y().v[kTurn + 0] = -d.z(), at.y().v[kTurn + 2] = d.x();
    at.z().v[kTurn + 0] = d.y(), at.z().v[kTurn + 1] = -d.x();
    std::array<Jet, BrownLens::coefficients> k;
    for (std::size_t i = 0; i < k.size(); ++i) k[i] = Jet(lens.distortion[i], 4 + static_cast<int>(i));
    const Eigen::Matrix<Jet, 2, 1> detected = BrownLens::distort(at, k.data());
    return {Jet(lens.principal.x(), 2) + Jet(lens.focal.x(), 0) * detected.x(),
            Jet(lens.principal.y(), 3) + Jet(lens.focal.y(), 1) * detected.y()};
  }
};

double squared_error(const Trial& trial, const std::vector<Sight>& sights) {
  double sum = 0;
  for (const Sight& sight : sights) {
    const auto at = trial.pixel(sight.direction);
    sum += (Vector<2>(at.x().a, at.y().a) - sight.pixel).squaredNorm();
  }
  return sum;
}

/// One step's equations; parameters that are held stay where they are.
Parameters step_of(const Trial& trial, const std::vector<Sight>& sights, const std::array<bool, kParameters>& held,
                   double damping) {
  Eigen::Matrix<double, kParameters, kParameters> A = Eigen::Matrix<double, kParameters, kParameters>::Zero();
  Parameters b = Parameters::Zero();
  for (const Sight& sight : sights) {
    const auto at = trial.pixel(sight.direction);
    for (int axis = 0; axis < 2; ++axis) {
      A += at[axis].v * at[axis].v.transpose();
      b -= at[axis].v * (at[axis].a - sight.pixel[axis]);
    }
  }
  for (int i = 0; i < kParameters; ++i) {
    A(i, i) += damping * A(i, i) + 1e-12;
    if (!held[static_cast<std::size_t>(i)]) continue;
    A.row(i).setZero();
    A.col(i).setZero();
    A(i, i) = 1;
    b[i] = 0;
  }
  return A.ldlt().solve(b);
}

}  // namespace

std::optional<BrownFit> fit_brown(const std::function<std::optional<Vector<3>>(const Vector<2>& pixel)>& direction, cv::Size size,
                                  const BrownLens& start, const BrownFitOptions& options) {
  constexpr int kColumns = 24, kRows = 18, kMinSights = 20, kMaxSteps = 200;
  std::vector<Sight> sights;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Vector<2> pixel((size.width - 1) * column / (kColumns - 1.0), (size.height - 1) * row / (kRows - 1.0));
      const auto ahead = direction(pixel);
      if (ahead && ahead->z() > 0.05 * ahead->norm()) sights.push_back({pixel, *ahead / ahead->z()});
    }
  }
  if (std::ssize(sights) < kMinSights) return std::nullopt;

  std::array<bool, kParameters> held{};
  for (int i = options.coefficients; i < BrownLens::coefficients; ++i) held[static_cast<std::size_t>(4 + i)] = true;
  for (int i = 0; i < 3; ++i) held[static_cast<std::size_t>(4 + BrownLens::coefficients + i)] = !options.turn;
  Trial best;
  best.lens = start;
  for (int i = options.coefficients; i < BrownLens::coefficients; ++i) best.lens.distortion[static_cast<std::size_t>(i)] = 0;
  double error = squared_error(best, sights);
  double damping = 1e-3;
  for (int i = 0; i < kMaxSteps && damping < 1e12; ++i) {
    const Parameters step = step_of(best, sights, held, damping);
    const Trial next = best.stepped(step);
    const double next_error = step.allFinite() ? squared_error(next, sights) : error;
    if (!(next_error < error)) {
      damping *= 8;
      continue;
    }
    const bool settled = error - next_error < 1e-14 * error + 1e-18;
    best = next;
    error = next_error;
    damping = std::max(damping / 8, 1e-12);
    if (settled) break;
  }
  return BrownFit{best.lens, best.turn, std::sqrt(error / static_cast<double>(sights.size()))};
}

}  // namespace marey::geometry
