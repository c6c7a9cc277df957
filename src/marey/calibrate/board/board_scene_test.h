#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/board/board_detector.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::board {

/// A portable stream of Gaussian numbers for the tests of this folder (simulate/ stands beside it, not below).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  double uniform() {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return (static_cast<double>(state_ >> 11) + 0.5) * 0x1.0p-53;
  }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double gaussian(double sigma) {
    return sigma * std::sqrt(-2 * std::log(uniform())) * std::cos(2 * 3.14159265358979323846 * uniform());
  }

 private:
  std::uint64_t state_;
};

/// A place in the cube round the origin with sides of twice `half`.
inline Vector<3> in_cube(Noise& noise, double half) {
  return {noise.uniform(-half, half), noise.uniform(-half, half), noise.uniform(-half, half)};
}

/// What a camera sees of a board that stands at `world_from_board`; nothing if a corner is out of the image. With a rolling
/// shutter, rows are exposed one after the other: `pose_of(share)` is the board's pose at that share of the image's height, -0.5
/// to 0.5.
template <typename PoseOf>
std::optional<BoardView> observe_board(const Camera& camera, const Board& board, const PoseOf& pose_of, double noise_px,
                                       Noise& noise) {
  BoardView view;
  for (int id = 0; id < board.corner_count(); ++id) {
    double fraction = 0;
    std::optional<Vector<2>> pixel;
    for (int i = 0; i < 4; ++i) {
      pixel = camera.project(pose_of(fraction) * board.corner(id));
      if (!pixel || !camera.in_image(*pixel)) return std::nullopt;
      fraction = (pixel->y() + 0.5) / camera.size().height - 0.5;
    }
    view.corners.push_back({id, *pixel + Vector<2>(noise.gaussian(noise_px), noise.gaussian(noise_px))});
  }
  return view;
}

/// A camera at `centre` that faces `target`, upright in a world with z up.
inline Rigid3 facing(const Vector<3>& centre, const Vector<3>& target) {
  const Vector<3> ahead = (target - centre).normalized();
  const Vector<3> right = ahead.cross(Vector<3>::UnitZ()).normalized();
  Rigid3 pose;
  pose.rotation.row(0) = right;
  pose.rotation.row(1) = ahead.cross(right);
  pose.rotation.row(2) = ahead;
  pose.translation = -(pose.rotation * centre);
  return pose;
}

}  // namespace marey::calibrate::board
