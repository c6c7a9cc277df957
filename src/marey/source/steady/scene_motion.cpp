#include "marey/source/steady/scene_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace marey::source::steady {
namespace {

constexpr int kVotes = 80;  // pairs: one of two places that stand is among them even where nine of ten move, nearly always
constexpr double kLargestRoll = 0.1;  // rad
constexpr double kRollPrior = 0.03;   // rad
constexpr double kScalePrior = 0.004;
constexpr double kPlaceNoise = 0.3;  // px, of a place that was followed

Matrix<3> rotation_of(const Vector<3>& turn) {
  const double angle = turn.norm();
  return angle < 1e-12 ? Matrix<3>::Identity().eval() : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

/// A turn and a shift of the picture as a whole, near enough to begin with.
struct PictureShift {
  double roll = 0;
  Vector<2> by = Vector<2>::Zero();  // of the principal point

  Vector<2> moved(const Vector<2>& from_middle) const {
    return from_middle + roll * Vector<2>(-from_middle.y(), from_middle.x()) + by;
  }
};

/// The shift that most places agree with, of those that two of them make.
PictureShift voted(std::span<const FollowedPlace> places, const PinholeView& view, double agree_px) {
  std::mt19937 random(20240229);  // NOLINT(cert-msc51-cpp): the same places give the same motion
  const auto any = [&] { return places[random() % places.size()]; };
  PictureShift best;
  int most = -1;
  for (int vote = 0; vote < kVotes; ++vote) {
    const FollowedPlace a = any(), b = any();
    const Vector<2> rest = b.rest - a.rest, seen = b.seen - a.seen;
    PictureShift shift;
    if (rest.squaredNorm() > 1) shift.roll = (rest.x() * seen.y() - rest.y() * seen.x()) / rest.squaredNorm();
    if (std::abs(shift.roll) > kLargestRoll) continue;
    shift.by = a.seen - view.principal - shift.moved(a.rest - view.principal);
    int agree = 0;
    for (const FollowedPlace& place : places) {
      const Vector<2> off = shift.moved(place.rest - view.principal) + view.principal - place.seen;
      agree += off.squaredNorm() < 16 * agree_px * agree_px ? 1 : 0;
    }
    if (agree <= most) continue;
    most = agree;
    best = shift;
  }
  return best;
}

struct SeenPlace {
  Vector<2> at;
  Eigen::Matrix<double, 2, 4> by_motion;
};

SeenPlace seen_of(const Vector<2>& rest, const SceneMotion& motion, const Matrix<3>& rotation, const PinholeView& view) {
  const Vector<2> flat = (rest - view.principal) / view.focal;
  const Vector<3> q = rotation * Vector<3>(flat.x(), flat.y(), 1);
  const double f = view.focal * std::exp(motion.log_scale);
  SeenPlace seen;
  seen.at = view.principal + f * q.head<2>() / q.z();
  Eigen::Matrix<double, 2, 3> by_ray;
  by_ray << f / q.z(), 0, -f * q.x() / (q.z() * q.z()), 0, f / q.z(), -f * q.y() / (q.z() * q.z());
  Matrix<3> cross;
  cross << 0, -q.z(), q.y(), q.z(), 0, -q.x(), -q.y(), q.x(), 0;
  seen.by_motion << by_ray * -cross, seen.at - view.principal;
  return seen;
}

void refine(SceneMotion& motion, std::span<const FollowedPlace> places, const PinholeView& view, double reach) {
  Matrix<4> information = Matrix<4>::Zero();
  const double roll = kPlaceNoise / kRollPrior, scale = kPlaceNoise / kScalePrior;
  information.diagonal() << 1e-6, 1e-6, roll * roll, scale * scale;
  Vector<4> slope(0, 0, roll * roll * motion.turn.z(), scale * scale * motion.log_scale);
  const Matrix<3> rotation = rotation_of(motion.turn);
  for (const FollowedPlace& place : places) {
    const SeenPlace seen = seen_of(place.rest, motion, rotation, view);
    const Vector<2> off = seen.at - place.seen;
    const double weight = 1 / std::pow(1 + off.squaredNorm() / (reach * reach), 2);
    information += weight * seen.by_motion.transpose() * seen.by_motion;
    slope += weight * seen.by_motion.transpose() * off;
  }
  const Vector<4> step = information.ldlt().solve(slope);
  const Eigen::AngleAxisd turned(rotation_of(-step.head<3>()) * rotation);
  motion.turn = turned.angle() * turned.axis();
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
  const Eigen::AngleAxisd turned(rotation_of(motion.turn) * rotation_of(rest.turn).transpose());
  return {turned.angle() * turned.axis(), motion.log_scale - rest.log_scale};
}

SceneMotion after(const SceneMotion& motion, const SceneMotion& first) {
  const Eigen::AngleAxisd turned(rotation_of(motion.turn) * rotation_of(first.turn));
  return {turned.angle() * turned.axis(), motion.log_scale + first.log_scale};
}

std::optional<SceneFit> fit_motion(std::span<const FollowedPlace> places, const PinholeView& view, double agree_px) {
  if (places.size() < 4) return std::nullopt;
  const PictureShift start = voted(places, view, agree_px);
  SceneFit fit;
  fit.motion.turn = {-start.by.y() / view.focal, start.by.x() / view.focal, start.roll};
  for (double reach = 6 * agree_px; reach > 0.6 * agree_px; reach /= 1.5) refine(fit.motion, places, view, reach);
  const Matrix<3> rotation = rotation_of(fit.motion.turn);
  Vector<2> sum = Vector<2>::Zero(), squares = Vector<2>::Zero();
  for (const FollowedPlace& place : places) {
    const double off = (seen_of(place.rest, fit.motion, rotation, view).at - place.seen).squaredNorm();
    fit.cost += std::min(off, agree_px * agree_px);
    if (off > agree_px * agree_px) continue;
    ++fit.agreeing;
    sum += place.rest;
    squares += place.rest.cwiseProduct(place.rest);
  }
  if (fit.agreeing > 0)
    fit.spread = std::sqrt(std::max(0.0, (squares / fit.agreeing - (sum / fit.agreeing).cwiseAbs2()).minCoeff()));
  return fit;
}

}  // namespace marey::source::steady
