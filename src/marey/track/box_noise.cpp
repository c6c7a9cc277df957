#include "marey/track/box_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace marey::track {
namespace {
static double env2(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; }
const double kFarStep = env2("BN_FAR", 0.24);       // s
const double kFirstCount = env2("BN_PRIOR", 60);      // of first levels, in differences
const double kMostRemembered = env2("BN_MOST", 4000);     // differences that are remembered
const double kOutlier = env2("BN_OUT", 9);     // times the mean
const double kLeastPlace = env2("BN_LP", 0.006), kMostPlace = 0.15;
const double kLeastAcceleration = env2("BN_LA", 0.1), kMostAcceleration = env2("BN_MA", 3);
const double kLeastSize = env2("BN_LS", 0.02), kMostSize = env2("BN_MS", 0.3);
const double kLeastDrift = env2("BN_LD", 0.05), kMostDrift = env2("BN_MD", 1);

}  // namespace

void BoxNoise::MeanSquare::add(double square, double first) {
  const double before = with_prior(first);
  square = std::min(square, kOutlier * before);
  count = std::min(count + 1, kMostRemembered);
  value += (square - value) / count;
}

double BoxNoise::MeanSquare::with_prior(double first) const {
  return (count * value + kFirstCount * first) / (count + kFirstCount);
}

std::size_t BoxNoise::far(double dt) const {
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(kFarStep / dt)), 2, (BoxTrail::kLength - 1) / 2);
}

void BoxNoise::see(const BoxTrail& trail, double dt) {
  if (dt <= 0) return;
  dt_ = dt;
  const BoxTrail::Entry* now = trail.back(0);
  if (now == nullptr) return;
  const double height = std::exp(now->log_height);
  const auto place = [&](std::size_t lag, MeanSquare& mean) {
    const BoxTrail::Entry *middle = trail.back(lag), *before = trail.back(2 * lag);
    if (middle == nullptr || before == nullptr) return;
    const Vector<2> second = (now->centre - 2 * middle->centre + before->centre) / height;
    const double h = static_cast<double>(lag) * dt;
    mean.add(second.squaredNorm() / 2,
             6 * first_.place * first_.place + 2.0 / 3 * first_.acceleration * first_.acceleration * h * h * h);
  };
  const auto size = [&](std::size_t lag, MeanSquare& mean) {
    const BoxTrail::Entry* before = trail.back(lag);
    if (before == nullptr) return;
    const double wider = now->log_width - before->log_width, higher = now->log_height - before->log_height;
    const double h = static_cast<double>(lag) * dt;
    mean.add((wider * wider + higher * higher) / 2, 2 * first_.size * first_.size + first_.drift * first_.drift * h);
  };
  place(1, place_near_);
  place(far(dt), place_far_);
  size(1, size_near_);
  size(far(dt), size_far_);
}

BoxNoiseLevels BoxNoise::levels() const {
  if (dt_ <= 0) return first_;
  const double k = static_cast<double>(far(dt_)), near = dt_, farther = k * dt_;
  const auto cube = [](double h) { return h * h * h; };
  const double q0 = first_.acceleration * first_.acceleration, R0 = first_.place * first_.place;
  const double near2 = place_near_.with_prior(6 * R0 + 2.0 / 3 * q0 * cube(near));
  const double far2 = place_far_.with_prior(6 * R0 + 2.0 / 3 * q0 * cube(farther));
  const double q = std::max(0.0, (far2 - near2) * 1.5 / (cube(farther) - cube(near)));
  const double R = std::max(0.0, (near2 - 2.0 / 3 * q * cube(near)) / 6);
  const double s0 = first_.size * first_.size, d0 = first_.drift * first_.drift;
  const double size_near = size_near_.with_prior(2 * s0 + d0 * near), size_far = size_far_.with_prior(2 * s0 + d0 * farther);
  const double d = std::max(0.0, (size_far - size_near) / (farther - near));
  const double s = std::max(0.0, (size_near - d * near) / 2);
  return {.place = std::clamp(std::sqrt(R), kLeastPlace, kMostPlace),
          .acceleration = std::clamp(std::sqrt(q), kLeastAcceleration, kMostAcceleration),
          .size = std::clamp(std::sqrt(s), kLeastSize, kMostSize),
          .drift = std::clamp(std::sqrt(d), kLeastDrift, kMostDrift)};
}

}  // namespace marey::track
