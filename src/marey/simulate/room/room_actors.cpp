#include "marey/simulate/room/room_actors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace marey::simulate::room {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kPropMarkers = 5;
constexpr double kPropReach = 0.12, kPropApart = 0.04;  // m, from its middle and between its markers

/// An ellipse whose axes turn slowly, at this many m/s; a follower is as far behind as all are apart.
BodyStance round_the_room(const RoomActor& actor, const RoomOptions& options, double t, double speed) {
  const double a = 0.33 * options.volume.x(), b = 0.23 * options.volume.y();
  const double round = speed * t / ((a + b) / 2) + kTurn * actor.number / actor.of, rotated = 0.05 * t + actor.first_angle;
  const Vector<2> along(-a * std::sin(round), b * std::cos(round));
  const double c = std::cos(rotated), s = std::sin(rotated), x = a * std::cos(round), y = b * std::sin(round);
  return {c * x - s * y, s * x + c * y, std::atan2(along.y(), along.x()) + rotated};
}

/// In the middle; several stand on a circle.
BodyStance in_the_room(const RoomActor& actor, const RoomOptions& options) {
  if (actor.of == 1) return {0, 0, actor.first_angle};
  const double round = kTurn * actor.number / actor.of, reach = 0.3 * std::min(options.volume.x(), options.volume.y());
  return {reach * std::cos(round), reach * std::sin(round), actor.first_angle + round};
}

}  // namespace

Sway Sway::drawn(double rate, Random& random) {
  return {rate * random.uniform(0.8, 1.2), rate * random.uniform(1.9, 2.6), random.uniform(0, kTurn), random.uniform(0, kTurn)};
}

double Sway::at(double t) const {
  return 0.72 * std::sin(slow * t + slow_phase) + 0.28 * std::sin(quick * t + quick_phase);
}

Drift Drift::drawn(double rate, Random& random) {
  return {{Sway::drawn(rate, random), Sway::drawn(rate, random), Sway::drawn(rate, random)}};
}

BodyPose RoomActor::pose(const RoomOptions& options, double t) const {
  switch (options.motion) {
    case RoomMotion::walk:
      return walking_pose(round_the_room(*this, options, t, 1.1), kTurn * t + step_phase);
    case RoomMotion::run:
      return running_pose(round_the_room(*this, options, t, 2.6), kTurn * 1.4 * t + step_phase);
    case RoomMotion::wave:
      return waving_pose(in_the_room(*this, options), t + 0.7 * number);
    case RoomMotion::kneel:
      return kneeling_pose(in_the_room(*this, options), t + 1.3 * number);
    case RoomMotion::roll:
      return rolling_pose(in_the_room(*this, options), t + 1.3 * number);
    default:
      return standing_pose(in_the_room(*this, options));
  }
}

Rigid3 RoomProp::pose(const RoomOptions& options, double t) const {
  const Vector<3> half = options.volume / 2;
  return {geometry::rotation_from(1.5 * turn.at(t)), Vector<3>(0, 0, half.z()) + 0.8 * half.cwiseProduct(location.at(t))};
}

RoomProp drawn_prop(int number, Random& random) {
  RoomProp prop;
  prop.body.id = BodyId{number};
  prop.body.label = fmt::format("prop{}", number);
  while (std::ssize(prop.body.markers) < kPropMarkers) {
    const double z = random.uniform(-kPropReach, kPropReach);
    const Vector<2> across = random.uniform_pair(-kPropReach, kPropReach, -kPropReach, kPropReach);
    const Vector<3> location(across.x(), across.y(), z);
    const bool free = std::all_of(prop.body.markers.begin(), prop.body.markers.end(),
                                  [&](const auto& other) { return (other.position - location).norm() > kPropApart; });
    if (free) prop.body.markers.push_back({fmt::format("{}_{}", prop.body.label, prop.body.markers.size() + 1), location});
  }
  prop.location = Drift::drawn(0.9, random);
  prop.turn = Drift::drawn(1.1, random);
  return prop;
}

}  // namespace marey::simulate::room
