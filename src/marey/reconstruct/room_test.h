// A room with cameras round it, for the tests of this folder.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/filter/random_stream.h"
#include "marey/geometry/camera.h"

namespace marey::reconstruct::room {

class Random {
 public:
  explicit Random(std::uint64_t seed) : stream_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(); }
  bool chance(double probability) { return stream_.uniform() < probability; }
  double gaussian(double sigma) { return sigma * stream_.normal_pair().first; }
  Vector<2> gaussian_2d(double sigma) {
    const auto [x, y] = stream_.normal_pair();
    return {sigma * x, sigma * y};
  }
  Vector<3> in_room() { return {uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(0, 2.2)}; }

 private:
  filter::RandomStream stream_;
};

/// At `centre`, aimed at `target`, with a little distortion: 1280 × 1024 px, 60° wide.
inline Camera facing(const Vector<3>& centre, const Vector<3>& target) {
  const Vector<3> z = (target - centre).normalized();
  const Vector<3> x = z.cross(Vector<3>::UnitZ()).normalized();
  Matrix<3> rotation;
  rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  geometry::BrownLens lens;
  lens.focal = {1000, 1004};
  lens.principal = {641, 509};
  lens.distortion = {-0.12, 0.05, 0.0004, -0.0003};
  return Camera(lens, Rigid3{rotation, -rotation * centre}, {1280, 1024});
}

/// On a circle, high and low by turns, all facing inwards.
inline std::vector<Camera> cameras_round(int count) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count + 0.1;
    cameras.push_back(facing({4 * std::cos(angle), 4 * std::sin(angle), i % 2 == 0 ? 2.5 : 1.7}, {0, 0, 1}));
  }
  return cameras;
}

}  // namespace marey::reconstruct::room
