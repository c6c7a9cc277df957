// Who and what moves in a room besides cameras: people with markers on them, and rigid bodies. Each is a function of time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/body.h"
#include "marey/core/geometry.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/body.h"
#include "marey/simulate/room/room.h"

namespace marey::simulate::room {

/// A smooth path to and fro that comes near every place between −1 and 1 in time: two sines of incommensurate rates.
struct Sway {
  double slow, quick, slow_phase, quick_phase;  // rad/s, rad

  static Sway drawn(double rate, Random& random);
  double at(double t) const;
};

struct Drift {
  std::array<Sway, 3> axes;
  static Drift drawn(double rate, Random& random);
  Vector<3> at(double t) const { return {axes[0].at(t), axes[1].at(t), axes[2].at(t)}; }
};

struct RoomActor {
  int number = 0, of = 1;
  std::string name;  ///< before its markers' labels: "" of the first, "actor2:" of the second
  std::vector<BodyMarker> markers;
  double first_angle = 0, step_phase = 0;

  BodyPose pose(const RoomOptions& options, double t) const;
};

struct RoomProp {
  Body body;
  Drift location, turn;

  Rigid3 pose(const RoomOptions& options, double t) const;
};

RoomProp drawn_prop(int number, Random& random);

}  // namespace marey::simulate::room
