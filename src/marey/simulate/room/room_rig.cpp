#include "marey/simulate/room/room_rig.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "marey/simulate/looking_at.h"
#include "marey/simulate/random.h"

namespace marey::simulate::room {
namespace {

Vector<3> some_direction(Random& random) {
  const double up = random.uniform(-1, 1), round = random.uniform(0, 2 * std::numbers::pi);
  const double aside = std::sqrt(1 - up * up);
  return {aside * std::cos(round), aside * std::sin(round), up};
}

geometry::BrownLens some_lens(const RoomOptions& options, Random& random) {
  geometry::BrownLens lens;
  const double focal = options.zoom * options.image.width * random.uniform(0.74, 0.80);  // about 66° across at 1
  lens.focal = {focal, focal * random.uniform(0.999, 1.001)};
  lens.principal = {options.image.width / 2.0 + random.uniform(-8, 8), options.image.height / 2.0 + random.uniform(-8, 8)};
  if (options.distorted) {
    lens.distortion = {random.uniform(-0.14, -0.06), random.uniform(0.01, 0.05), random.uniform(-5e-4, 5e-4),
                       random.uniform(-5e-4, 5e-4)};
  }
  return lens;
}

}  // namespace

Rig room_rig(const RoomOptions& options) {
  constexpr double kBehind = 1.2;  // m from the volume's edge to the cameras
  Random random(options.seed * 2654435761u + 1);
  Rig rig;
  const Vector<3> target(0, 0, 0.42 * options.volume.z());
  for (int i = 0; i < options.cameras; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5 + random.uniform(-0.15, 0.15)) / options.cameras;
    const double height = options.volume.z() * (i % 2 == 0 ? 1.05 : 0.75) + random.uniform(-0.1, 0.1);
    const Vector<3> centre((options.volume.x() / std::numbers::sqrt2 + kBehind) * std::cos(angle),
                           (options.volume.y() / std::numbers::sqrt2 + kBehind) * std::sin(angle), height);
    const Vector<3> aim = target + 0.15 * some_direction(random);
    RigCamera camera;
    camera.name = fmt::format("cam{}", i + 1);
    camera.rate_hz = options.rate_hz;
    camera.size = options.image;
    camera.lens = some_lens(options, random);
    camera.camera_from_world = looking_at(centre, aim);
    const double offset = random.uniform(-options.offset_s, options.offset_s);
    camera.offset_s = i == 0 ? 0 : offset;
    rig.cameras.push_back(std::move(camera));
  }
  return rig;
}

Rig bumped(const Rig& rig, const RoomOptions& options) {
  Rig result = rig;
  if (!options.bump) return result;
  Random random(options.seed * 2654435761u + 2);
  Rigid3& pose = *result.cameras[static_cast<std::size_t>(options.bump->camera)].camera_from_world;
  Rigid3 push;
  push.rotation = geometry::rotation_from(options.bump->angle * some_direction(random));
  push.translation = options.bump->angle * some_direction(random);
  pose = push * pose;
  return result;
}

}  // namespace marey::simulate::room
