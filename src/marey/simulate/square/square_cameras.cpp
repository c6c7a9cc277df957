#include "marey/simulate/square/square_cameras.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/simulate/looking_at.h"
#include "marey/simulate/random.h"

namespace marey::simulate::square {
namespace {

constexpr int kMaxCameras = 64;

}  // namespace

Rig square_cameras(int cameras, double rate_hz, const SquareOptions& square, std::uint64_t seed) {
  if (cameras < 1 || cameras > kMaxCameras) throw Error("a square with {} cameras; 1 to {} are possible", cameras, kMaxCameras);
  Random random(seed * 40503 + 11);
  Rig rig;
  const Vector<2> middle(square.length / 2, square.width / 2);
  for (int i = 0; i < cameras; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform(0.3, 0.7)) / cameras;
    const Vector<2> to(std::cos(angle), std::sin(angle));
    const Vector<2> half = middle + Vector<2>(3, 4);
    const Vector<2> at = middle + to / std::max(std::abs(to.x()) / half.x(), std::abs(to.y()) / half.y());
    const Vector<2> aim = middle + 0.25 * (at - middle) + random.uniform_pair(-3, 3, -1, 1);
    RigCamera camera;
    camera.name = fmt::format("cam{}", i + 1);
    camera.rate_hz = rate_hz;
    camera.offset_s = 0;
    camera.size = cv::Size(1920, 1080);
    geometry::BrownLens lens;
    const double focal = random.uniform(0.7, 0.9) * 1920;
    lens.focal = {focal, focal};
    lens.principal = {959.5, 539.5};
    camera.lens = lens;
    camera.camera_from_world = looking_at({at.x(), at.y(), random.uniform(2, 4)}, {aim.x(), aim.y(), 0.9});
    rig.cameras.push_back(camera);
  }
  rig.calibration.emplace().method = "simulated: the exact truth";
  return rig;
}

}  // namespace marey::simulate::square
