#include "marey/source/stabilise/scene_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace marey::source::stabilise {
namespace {

constexpr int kVotes = 80;  // pairs: one of two places that stand is among them even where nine of ten move, nearly always
constexpr double kMaxRollAngle = 0.1;  // rad
constexpr double kRollPrior = 0.03;    // rad
constexpr double kScalePrior = 0.004;
constexpr double kPositionNoise = 0.3;  // px, of a place that was followed

Matrix<3> rotation_of(const Vector<3>& turn) {
  const double angle = turn.norm();
  return angle < 1e-12 ? Matrix<3>::Identity().eval() : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

/// A turn and a shift of the image as a whole, near enough to begin with.
struct ImageShift {
  double roll = 0;
  Vector<2> by = Vector<2>::Zero();  // of the principal point

  Vector<2> moved(const Vector<2>& from_middle) const {
    return from_middle + roll * Vector<2>(-from_middle.y(), from_middle.x()) + by;
  }
};

/// The shift that most places agree with, of those that two of them make.
ImageShift voted(std::span<const TrackedPosition> locations, const PinholeView& view, double agree_px) {
  std::mt19937 random(20240229);  // NOLINT(cert-msc51-cpp): the same places give the same motion
  const auto any = [&] { return locations[random() % locations.size()]; };
  ImageShift best;
  int maximum = -1;
  for (int vote = 0; vote < kVotes; ++vote) {
    const TrackedPosition a = any(), b = any();
    const Vector<2> rest = b.rest - a.rest, detected = b.detected - a.detected;
    ImageShift shift;
    if (rest.squaredNorm() > 1) shift.roll = (rest.x() * detected.y() - rest.y() * detected.x()) / rest.squaredNorm();
    if (std::abs(shift.roll) > kMaxRollAngle) continue;
    shift.by = a.detected - view.principal - shift.moved(a.rest - view.principal);
    int agree = 0;
    for (const TrackedPosition& location : locations) {
      const Vector<2> off = shift.moved(location.rest - view.principal) + view.principal - location.detected;
      agree += off.squaredNorm() < 16 * agree_px * agree_px ? 1 : 0;
    }
    if (agree <= maximum) continue;
    maximum = agree;
    best = shift;
  }
  return best;
}

struct ObservedPosition {
  Vector<2> at;
  Eigen::Matrix<double, 2, 4> by_motion;
};

ObservedPosition observed_of(const Vector<2>& rest, const SceneMotion& motion, const Matrix<3>& rotation, const PinholeView& view) {
  const Vector<2> flat = (rest - view.principal) / view.focal;
  const Vector<3> q = rotation * Vector<3>(flat.x(), flat.y(), 1);
  const double f = view.focal * std::exp(motion.log_scale);
  ObservedPosition detected;
  detected.at = view.principal + f * q.head<2>() / q.z();
  Eigen::Matrix<double, 2, 3> by_ray;
  by_ray << f / q.z(), 0, -f * q.x() / (q.z() * q.z()), 0, f / q.z(), -f * q.y() / (q.z() * q.z());
  Matrix<3> cross;
  cross << 0, -q.z(), q.y(), q.z(), 0, -q.x(), -q.y(), q.x(), 0;
  detected.by_motion << by_ray * -cross, detected.at - view.principal;
  return detected;
}

void refine(SceneMotion& motion, std::span<const TrackedPosition> locations, const PinholeView& view, double reach) {
  Matrix<4> information = Matrix<4>::Zero();
  const double roll = kPositionNoise / kRollPrior, scale = kPositionNoise / kScalePrior;
  information.diagonal() << 1e-6, 1e-6, roll * roll, scale * scale;
  Vector<4> slope(0, 0, roll * roll * motion.turn.z(), scale * scale * motion.log_scale);
  const Matrix<3> rotation = rotation_of(motion.turn);
  for (const TrackedPosition& location : locations) {
    const ObservedPosition detected = observed_of(location.rest, motion, rotation, view);
    const Vector<2> off = detected.at - location.detected;
    const double weight = 1 / std::pow(1 + off.squaredNorm() / (reach * reach), 2);
    information += weight * detected.by_motion.transpose() * detected.by_motion;
    slope += weight * detected.by_motion.transpose() * off;
  }
  const Vector<4> step = information.ldlt().solve(slope);
  const Eigen::AngleAxisd rotated(rotation_of(-step.head<3>()) * rotation);
  motion.turn = rotated.angle() * rotated.axis();
  motion.log_scale -= step[3];
}

}  // namespace

Matrix<3> moved_from_rest(const SceneMotion& motion, const PinholeView& view) {
  const double f = view.focal * std::exp(motion.log_scale);
  Matrix<3> to_pixel = Matrix<3>::Identity(), from_pixel = Matrix<3>::Identity();
  to_pixel << f, 0, view.principal.x(), 0, f, view.principal.y(), 0, 0, 1;
  from_pixel << 1 / view.focal, 0, -view.principal.x() / view.focal, 0, 1 / view.focal, -view.principal.y() / view.focal, 0, 0, 1;
  return to_pixel * rotation_of(motion.turn) * from_pixel;
}

SceneMotion against(const SceneMotion& motion, const SceneMotion& rest) {
  const Eigen::AngleAxisd rotated(rotation_of(motion.turn) * rotation_of(rest.turn).transpose());
  return {rotated.angle() * rotated.axis(), motion.log_scale - rest.log_scale};
}

SceneMotion after(const SceneMotion& motion, const SceneMotion& first) {
  const Eigen::AngleAxisd rotated(rotation_of(motion.turn) * rotation_of(first.turn));
  return {rotated.angle() * rotated.axis(), motion.log_scale + first.log_scale};
}

std::optional<SceneFit> fit_motion(std::span<const TrackedPosition> locations, const PinholeView& view, double agree_px) {
  if (locations.size() < 4) return std::nullopt;
  const ImageShift start = voted(locations, view, agree_px);
  SceneFit fit;
  fit.motion.turn = {-start.by.y() / view.focal, start.by.x() / view.focal, start.roll};
  for (double reach = 6 * agree_px; reach > 0.6 * agree_px; reach /= 1.5) refine(fit.motion, locations, view, reach);
  const Matrix<3> rotation = rotation_of(fit.motion.turn);
  Vector<2> sum = Vector<2>::Zero(), squares = Vector<2>::Zero();
  for (const TrackedPosition& location : locations) {
    const double off = (observed_of(location.rest, fit.motion, rotation, view).at - location.detected).squaredNorm();
    fit.cost += std::min(off, agree_px * agree_px);
    if (off > agree_px * agree_px) continue;
    ++fit.agreeing;
    sum += location.rest;
    squares += location.rest.cwiseProduct(location.rest);
  }
  if (fit.agreeing > 0)
    fit.spread = std::sqrt(std::max(0.0, (squares / fit.agreeing - (sum / fit.agreeing).cwiseAbs2()).minCoeff()));
  return fit;
}

}  // namespace marey::source::stabilise
