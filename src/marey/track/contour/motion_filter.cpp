// Constant velocity in each axis and constant growth, with white acceleration (as filter/kalman.h) and a random walk of the growth.
// The paper's filter holds velocity and growth alone and takes the centre from the outline as it is; this one holds the centre too,
// so that the trajectory does not swing with every step of the legs.
#include "marey/track/contour/motion_filter.h"

#include <cmath>

namespace marey::track::contour {

MotionFilter::MotionFilter(const Vector<2>& centre, const Vector<2>& velocity, double growth, double centre_deviation,
                           double velocity_deviation, double growth_deviation)
    : centre_(centre),
      velocity_(velocity),
      growth_(growth),
      Pcc_(Vector<2>::Constant(centre_deviation * centre_deviation)),
      Pcv_(Vector<2>::Zero()),
      Pvv_(Vector<2>::Constant(velocity_deviation * velocity_deviation)),
      Pss_(growth_deviation * growth_deviation) {}

void MotionFilter::predict(double dt, const MotionNoise& noise) {
  centre_ += dt * velocity_;
  const double q = noise.acceleration * noise.acceleration * dt;
  Pcc_ += 2 * dt * Pcv_ + dt * dt * Pvv_ + Vector<2>::Constant(q * dt * dt / 3);
  Pcv_ += dt * Pvv_ + Vector<2>::Constant(q * dt / 2);
  Pvv_ += Vector<2>::Constant(q);
  Pss_ += noise.growth * noise.growth * dt;
}

void MotionFilter::correct_centre(const Vector<2>& measured, const Vector<2>& deviation) {
  for (int axis = 0; axis < 2; ++axis) {
    const double S = Pcc_[axis] + deviation[axis] * deviation[axis];
    const double Kc = Pcc_[axis] / S, Kv = Pcv_[axis] / S;
    const double innovation = measured[axis] - centre_[axis];
    centre_[axis] += Kc * innovation;
    velocity_[axis] += Kv * innovation;
    Pvv_[axis] -= Kv * Pcv_[axis];
    Pcv_[axis] *= 1 - Kc;
    Pcc_[axis] *= 1 - Kc;
  }
}

void MotionFilter::correct_growth(double measured, double deviation) {
  const double K = Pss_ / (Pss_ + deviation * deviation);
  growth_ += K * (measured - growth_);
  Pss_ *= 1 - K;
}

Vector<2> MotionFilter::centre_deviation() const {
  return Pcc_.cwiseMax(0).cwiseSqrt();
}
Vector<2> MotionFilter::velocity_deviation() const {
  return Pvv_.cwiseMax(0).cwiseSqrt();
}
double MotionFilter::growth_deviation() const {
  return std::sqrt(Pss_);
}

}  // namespace marey::track::contour
