#include "marey/simulate/room/to_and_fro.h"

#include <algorithm>
#include <cmath>

namespace marey::simulate::room {
namespace {

constexpr double kMaxRamp = 0.5;  // s; feet that move at 4 m/s then turn at 8 m/s², less than in a step

}  // namespace

double to_and_fro(double time_s, double length_s) {
  if (length_s <= 0) return 0;
  const double in_period = std::fmod(std::abs(time_s), 2 * length_s);
  const double time = std::min(in_period, 2 * length_s - in_period);  // since the last turn at 0, or until the next one
  const double ramp = std::min(kMaxRamp, length_s / 2);
  const auto ramped = [&](double t) { return t * t / (2 * ramp); };
  const double whole = length_s - ramp;
  if (time < ramp) return ramped(time);
  return time <= length_s - ramp ? time - ramp / 2 : whole - ramped(length_s - time);
}

}  // namespace marey::simulate::room
