#include "marey/simulate/match/operator_motion.h"

#include <algorithm>
#include <cmath>

namespace marey::simulate::match {
namespace {

constexpr double kOperatorStep = 0.02;     // s, of the simulation
constexpr double kTrembleFrequency = 12;   // rad/s
constexpr double kClosenessTime = 6;       // s: how long the operator keeps a size of image
constexpr double kClosenessSpread = 0.22;  // of ln f
constexpr double kWhipAnswer = 7;          // rad/s
constexpr double kMinLogFocal = 0.4, kMaxLogFocal = 2.3;

}  // namespace

OperatorMotion::OperatorMotion(const geometry::Tripod& tripod, const geometry::PitchSize& pitch, const OperatorOptions& options,
                               std::uint64_t seed)
    : tripod_(tripod), pitch_(pitch), options_(options), random_(seed * 2654435761u + 71) {}

void OperatorMotion::Spring::pull(double target, double frequency, double step) {
  speed += step * (frequency * frequency * (target - value) - 2 * frequency * speed);
  value += step * speed;
}

geometry::Heading OperatorMotion::required(const Vector<2>& ball) const {
  const Vector<2> middle(pitch_.length / 2, pitch_.width / 2);
  const Vector<2> aim = middle + Vector<2>(0.86 * (ball.x() - middle.x()), 0.6 * (ball.y() - middle.y()));
  const Vector<2> off = aim - tripod_.location.head<2>();
  const double far = off.norm();
  geometry::Heading heading;
  heading.pan = std::atan2(off.x(), off.y());
  heading.tilt = std::atan2(tripod_.location.z(), far);
  heading.log_focal =
      std::clamp(std::log(2 * std::hypot(far, tripod_.location.z()) / options_.width) + closeness_, kMinLogFocal, kMaxLogFocal);
  return heading;
}

void OperatorMotion::advance(const geometry::Heading& aim, double step) {
  const double off = std::hypot(aim.pan - pan_.value, aim.tilt - tilt_.value);
  if (off > options_.patience) tracking_ = true;
  if (off < 0.2 * options_.patience) tracking_ = false;
  closeness_ +=
      step * (-closeness_ / kClosenessTime) + kClosenessSpread * std::sqrt(2 * step / kClosenessTime) * random_.gaussian();
  if (options_.whips > 0 && whip_.left_s <= -1 && random_.chance(options_.whips * step))
    whip_ = {random_.uniform(0.5, 1.2), (random_.chance(0.5) ? 1 : -1) * random_.uniform(0.25, 0.5)};
  whip_.left_s -= step;
  const bool whips = options_.whips > 0 && whip_.left_s > 0;
  if (whips)
    pan_.pull(std::clamp(aim.pan + whip_.pan, -0.95, 0.95), kWhipAnswer, step);
  else
    pan_.pull(tracking_ ? aim.pan : pan_.value, options_.answer, step);
  tilt_.pull(tracking_ ? aim.tilt : tilt_.value, options_.answer, step);
  log_focal_.pull(tracking_ ? aim.log_focal : log_focal_.value, options_.zoom, step);
  // White noise through a critically damped spring of frequency w has the variance w S / 4 for a density S.
  for (Spring& axis : shake_) {
    const double push = options_.tremble * std::sqrt(4 / (kTrembleFrequency * step)) * random_.gaussian();
    axis.pull(push, kTrembleFrequency, step);
  }
}

geometry::Heading OperatorMotion::track_ball(const Vector<2>& ball, double step) {
  const geometry::Heading aim = required(ball);
  if (!begun_) pan_.value = aim.pan, tilt_.value = aim.tilt, log_focal_.value = aim.log_focal;
  const int steps = begun_ ? std::max(1, static_cast<int>(std::lround(step / kOperatorStep))) : 0;
  begun_ = true;
  for (int i = 0; i < steps; ++i) advance(required(ball), step / steps);
  return {pan_.value + shake_[0].value, tilt_.value + shake_[1].value, log_focal_.value};
}

}  // namespace marey::simulate::match
