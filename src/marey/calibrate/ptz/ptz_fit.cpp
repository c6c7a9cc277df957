#include "marey/calibrate/ptz/ptz_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <ceres/jet.h>

#include "marey/geometry/median.h"

namespace marey::calibrate::ptz {
namespace {

using Jet = ceres::Jet<double, 3>;

geometry::TripodFrame<Jet> jet_frame(const geometry::Tripod& tripod, const geometry::Heading& heading) {
  const auto numbers = tripod.as_numbers();
  std::array<Jet, geometry::Tripod::numbers> still;
  for (std::size_t i = 0; i < still.size(); ++i) still[i] = Jet(numbers[i]);
  const std::array<Jet, 3> ptz{Jet(heading.pan, 0), Jet(heading.tilt, 1), Jet(heading.log_focal, 2)};
  return {still.data(), ptz.data()};
}

struct Residual {
  double off = 0;  // px
  Vector<3> by_heading = Vector<3>::Zero();
};

Residual residual_of(const geometry::TripodFrame<Jet>& frame, cv::Size size, const PaintSighting& one) {
  const Eigen::Matrix<Jet, 3, 1> location(Jet(one.ground.x()), Jet(one.ground.y()), Jet(0));
  const auto detected = frame.detected(location);
  const Vector<2> pixel = geometry::to_pixel({detected.x().a, detected.y().a}, size), normal = one.normal.cast<double>();
  return {normal.dot(pixel - one.pixel.cast<double>()),
          size.width / 2.0 * (normal.x() * detected.x().v + normal.y() * detected.y().v)};
}

/// Of each sighting.
std::vector<double> line_weights(std::span<const PaintSighting> paint, double per_line) {
  std::vector<int> count;
  for (const PaintSighting& one : paint) {
    if (one.line >= kFirstClick) continue;
    if (one.line >= static_cast<int>(count.size())) count.resize(one.line + 1, 0);
    ++count[one.line];
  }
  std::vector<double> weights;
  for (const PaintSighting& one : paint)
    weights.push_back(one.line >= kFirstClick ? 1 : std::min(1.0, per_line / std::max(1, count[one.line])));
  return weights;
}

void assess(std::span<const PaintSighting> paint, const geometry::TripodFrame<Jet>& frame, cv::Size size, double cut_off,
            AimFit& fit) {
  std::vector<double> near;
  std::vector<int> of_line;
  for (const PaintSighting& one : paint) {
    if (one.line >= kFirstClick) continue;
    const double off = std::abs(residual_of(frame, size, one).off);
    if (off > cut_off * one.sigma) continue;
    near.push_back(off);
    if (one.line >= static_cast<int>(of_line.size())) of_line.resize(one.line + 1, 0);
    ++of_line[one.line];
  }
  fit.agreeing = static_cast<int>(near.size());
  fit.lines = static_cast<int>(std::count_if(of_line.begin(), of_line.end(), [](int n) { return n >= 3; }));
  if (near.empty()) return;
  fit.median_px = geometry::median(near);
}

}  // namespace

AimFit solve_aim(const geometry::Tripod& tripod, cv::Size size, std::span<const PaintSighting> paint, const Aim& expected,
                 const AimOptions& options) {
  const std::vector<double> weights = line_weights(paint, options.per_line);
  const Matrix<3> prior = expected.covariance.inverse();
  Vector<3> at = expected.heading.as_vector();
  Matrix<3> information = prior;
  double loose = 4;  // the cut-off is wide at first
  for (int i = 0; i < options.iterations; ++i, loose = std::max(1.0, loose / 1.6)) {
    const auto frame = jet_frame(tripod, geometry::Heading::of(at));
    information = prior;
    Vector<3> slope = prior * (at - expected.heading.as_vector());
    for (std::size_t k = 0; k < paint.size(); ++k) {
      const PaintSighting& one = paint[k];
      const Residual residual = residual_of(frame, size, one);
      const double scaled = residual.off / (loose * options.cut_off * one.sigma);
      const double robust = 1 / std::pow(1 + scaled * scaled, 2);  // Geman and McClure's
      const double weight = robust * weights[k] / (one.sigma * one.sigma);
      information += weight * residual.by_heading * residual.by_heading.transpose();
      slope += weight * residual.off * residual.by_heading;
    }
    const Vector<3> step = information.ldlt().solve(slope);
    at -= step;
    if (loose <= 1 && step.head<2>().norm() * size.width < 1e-3 && std::abs(step.z()) < 1e-6) break;
  }
  AimFit fit{{geometry::Heading::of(at), information.inverse()}};
  assess(paint, jet_frame(tripod, fit.aim.heading), size, options.cut_off, fit);
  return fit;
}

Eigen::Matrix<double, 2, 3> pixel_by_heading(const geometry::Tripod& tripod, const geometry::Heading& heading, cv::Size size,
                                             const Vector<3>& location) {
  const auto detected = jet_frame(tripod, heading).detected(location.cast<Jet>());
  Eigen::Matrix<double, 2, 3> result;
  result.row(0) = size.width / 2.0 * detected.x().v.transpose();
  result.row(1) = size.width / 2.0 * detected.y().v.transpose();
  return result;
}

}  // namespace marey::calibrate::ptz
