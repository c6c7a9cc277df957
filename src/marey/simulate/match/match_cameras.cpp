#include "marey/simulate/match/match_cameras.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/simulate/looking_at.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {
namespace {

constexpr int kMaxCameras = 64;
constexpr double kBehind = 14;  // m from the lines to the cameras

class Builder {
 public:
  Builder(const MatchCamerasOptions& options, std::uint64_t seed) : options_(options), random_(seed * 2654435761u + 21) {}

  Rig build() {
    rig_.ground = options_.ground;
    rig_.ground.half = Vector<2>(options_.pitch.length, options_.pitch.width) / 2;
    rig_.ground.middle = rig_.ground.half;
    switch (options_.stand) {
      case MatchStand::round:
        round();
        break;
      case MatchStand::football:
        football();
        break;
      case MatchStand::corners:
        corners();
        break;
      case MatchStand::apart:
        football();
        break;
      case MatchStand::sides:
        sides();
        break;
    }
    rig_.calibration.emplace().method = "simulated: the exact truth";
    return std::move(rig_);
  }

 private:
  /// `focal` in widths of the image.
  void add(const std::string& name, cv::Size typical, double focal, const Vector<3>& centre, const Vector<3>& target) {
    RigCamera camera;
    camera.name = name;
    camera.rate_hz = options_.rate_hz;
    camera.size = options_.size.value_or(typical);
    geometry::BrownLens lens;
    const double px = focal * camera.size->width * random_.uniform(0.99, 1.01);
    lens.focal = {px, px};
    lens.principal = {(camera.size->width - 1) / 2.0 + 0.01 * camera.size->width * random_.uniform(-1, 1),
                      (camera.size->height - 1) / 2.0 + 0.01 * camera.size->width * random_.uniform(-1, 1)};
    const double bend = random_.uniform(-0.16, -0.10);
    if (options_.distorted) lens.distortion = {bend, 0.16 * -bend, random_.uniform(-5e-4, 5e-4), random_.uniform(-5e-4, 5e-4)};
    camera.lens = lens;
    camera.camera_from_world = looking_at(
        centre, target,
        options_.stand == MatchStand::football || options_.stand == MatchStand::apart ? random_.uniform(-0.015, 0.015) : 0);
    const double offset = random_.uniform(-options_.offset_s, options_.offset_s);
    camera.offset_s = rig_.cameras.empty() ? 0 : offset;
    rig_.cameras.push_back(std::move(camera));
  }

  Vector<2> jitter(double maximum) { return {random_.uniform(-maximum, maximum), random_.uniform(-maximum, maximum)}; }

  void round() {
    const Vector<2> middle(options_.pitch.length / 2, options_.pitch.width / 2);
    for (int i = 0; i < options_.cameras; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.25) / options_.cameras - std::numbers::pi / 2;
      // On a rounded rectangle round the lines.
      const Vector<2> to(std::cos(angle), std::sin(angle));
      const Vector<2> half = middle + Vector<2>(kBehind, kBehind);
      const double reach =
          1 / std::pow(std::pow(std::abs(to.x()) / half.x(), 6) + std::pow(std::abs(to.y()) / half.y(), 6), 1.0 / 6);
      const Vector<2> at = middle + reach * to + jitter(1);
      const Vector<2> aim = middle - 0.12 * reach * to + jitter(1);
      add(fmt::format("cam{}", i + 1), {1920, 1080}, 0.56, {at.x(), at.y(), 12 + random_.uniform(-1, 1)}, {aim.x(), aim.y(), 0});
    }
  }

  void sides() {
    const double length = options_.pitch.length, width = options_.pitch.width;
    for (int i = 0; i < options_.cameras; ++i) {
      const bool far = i >= (options_.cameras + 1) / 2;
      const int first = far ? (options_.cameras + 1) / 2 : 0;
      const int along = far ? options_.cameras - first : (options_.cameras + 1) / 2;
      const Vector<2> at = Vector<2>(length * (i - first + 0.5) / along, far ? width + kBehind : -kBehind) + jitter(1);
      const Vector<2> aim = Vector<2>(at.x(), width * (far ? 0.6 : 0.4)) + jitter(1);
      add(fmt::format("cam{}", i + 1), {1920, 1080}, 0.8, {at.x(), at.y(), 12 + random_.uniform(-1, 1)}, {aim.x(), aim.y(), 0});
    }
  }

  void football() {
    // As football's own user counts: y grows towards the cameras, so that the world's y is −y.
    Matrix<3> ground_from_world = Matrix<3>::Identity();
    ground_from_world(1, 1) = -1;
    rig_.ground_from_world = ground_from_world;
    rig_.ground.middle.y() *= -1;
    const double x = options_.pitch.length / 2 - 1 + random_.uniform(-1, 1),
                 y = -(options_.pitch.width + kBehind + random_.uniform(-0.5, 0.5));
    const double height = 7.4 + random_.uniform(-0.2, 0.2);
    for (const double side : {-1.0, 1.0}) {
      const Vector<3> ahead(side * 0.47, 0.87, -0.165);
      const double off = options_.stand == MatchStand::apart ? options_.pitch.length / 4 : 0.25;
      const Vector<3> centre(x + off * side, y, height);
      add(side < 0 ? "left" : "right", {3072, 1728}, 0.686, centre, centre + ahead);
    }
  }

  void corners() {
    const double length = options_.pitch.length, width = options_.pitch.width;
    const Vector<3> middle(length / 2, width / 2, 0);
    int number = 1;
    for (const double side : {-1.0, 1.0}) {
      const Vector<2> away = jitter(0.5);
      const Vector<3> centre =
          middle + side * Vector<3>(length / 2 + 9 + away.x(), width / 2 + 7 + away.y(), 0) + Vector<3>(0, 0, 15);
      add(fmt::format("cam{}", number++), {3072, 1728}, 0.56, centre, middle - 0.06 * side * Vector<3>(length, width, 0));
    }
  }

  const MatchCamerasOptions& options_;
  Random random_;
  Rig rig_;
};

}  // namespace

Rig match_cameras(const MatchCamerasOptions& options, std::uint64_t seed) {
  const bool counted = options.stand == MatchStand::round || options.stand == MatchStand::sides;
  if (counted && (options.cameras < 1 || options.cameras > kMaxCameras))
    throw Error("{} cameras round a match; 1 to {} are possible", options.cameras, kMaxCameras);
  if (!(options.rate_hz > 0) || !std::isfinite(options.rate_hz))
    throw Error("a rate of {} frames a second; it must be positive", options.rate_hz);
  if (!(options.offset_s >= 0) || !std::isfinite(options.offset_s))
    throw Error("cameras started within {} s of each other; it cannot be negative", options.offset_s);
  if (options.size && (options.size->width < 64 || options.size->height < 64))
    throw Error("images of {} x {} pixels; 64 x 64 is the least", options.size->width, options.size->height);
  if (!(options.pitch.length >= 40 && options.pitch.width >= 25))
    throw Error("a pitch of {} x {} m; 40 x 25 m is the least", options.pitch.length, options.pitch.width);
  const geometry::GroundSurface& ground = options.ground;
  for (const double height : {ground.across, ground.along, ground.dome}) {
    if (!(std::abs(height) <= geometry::GroundSurface::kMaxLevel))
      throw Error("a pitch raised by {} m; up to {} m are possible", height, geometry::GroundSurface::kMaxLevel);
  }
  return Builder(options, seed).build();
}

}  // namespace marey::simulate::match
