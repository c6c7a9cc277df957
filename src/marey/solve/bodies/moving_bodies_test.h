// Bodies on smooth paths, for the tests of this room.
#pragma once

#include <cmath>
#include <vector>

#include "marey/core/body.h"
#include "marey/filter/random_stream.h"
#include "marey/geometry/rigid.h"

namespace marey::solve::bodies::moving {

class Random {
 public:
  explicit Random(std::uint64_t seed) : stream_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(); }
  bool chance(double probability) { return stream_.uniform() < probability; }
  Vector<3> gaussian(double sigma) {
    const auto [x, y] = stream_.normal_pair();
    return sigma * Vector<3>(x, y, stream_.normal_pair().first);
  }
  Vector<3> in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  filter::RandomStream stream_;
};

/// Swings and turns without a jump: some tenths of a metre, up to two turns a second.
class Path {
 public:
  Path(Random& random, const Vector<3>& about) : about_(about) {
    for (int i = 0; i < 6; ++i) rates_[i] = random.uniform(0.3, 1.2), phases_[i] = random.uniform(0, 6);
    axis_ = random.in_box(1).normalized();
    rotations_ = random.uniform(-1, 1);
  }
  Rigid3 at(double time) const {
    Vector<3> location, angles;
    for (int i = 0; i < 3; ++i) {
      location[i] = 0.4 * std::sin(6.283 * rates_[i] * time + phases_[i]);
      angles[i] = 0.5 * std::sin(6.283 * rates_[3 + i] * time + phases_[3 + i]);
    }
    return {geometry::rotation_from(angles) * geometry::rotation_from(6.283 * rotations_ * time * axis_), about_ + location};
  }

 private:
  Vector<3> about_, axis_;
  double rates_[6], phases_[6], rotations_ = 0;
};

inline Body body_of(int id, const std::vector<Vector<3>>& locations) {
  Body body;
  body.id = BodyId{id};
  body.label = "body " + std::to_string(id);
  for (const Vector<3>& location : locations)
    body.markers.push_back({body.label + ":" + std::to_string(body.markers.size()), location});
  return body;
}

/// Markers at least `apart` m from each other, and no two of their distances within `apart` / 4.
inline std::vector<Vector<3>> scattered(Random& random, int count, double half, double apart) {
  for (;;) {
    std::vector<Vector<3>> locations;
    std::vector<double> distances;
    bool good = true;
    for (int i = 0; i < count && good; ++i) {
      locations.push_back(random.in_box(half));
      for (int k = 0; k < i; ++k) {
        const double distance = (locations[static_cast<std::size_t>(i)] - locations[static_cast<std::size_t>(k)]).norm();
        good &= distance > apart;
        for (const double other : distances) good &= std::abs(other - distance) > apart / 4;
        distances.push_back(distance);
      }
    }
    if (good) return locations;
  }
}

inline double degrees_between(const Rigid3& a, const Rigid3& b) {
  return geometry::angle_axis_of(a.rotation * b.rotation.transpose()).norm() * 57.29577951;
}

}  // namespace marey::solve::bodies::moving
