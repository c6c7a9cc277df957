#include "marey/simulate/match/goal_posts.h"

#include <Eigen/Geometry>

namespace marey::simulate::match {
namespace {

constexpr double kGoalWidth = 7.32, kGoalHeight = 2.44, kPostWidth = 0.12;  // m

}  // namespace

Vector<2> in_world(const Matrix<3>& world_from_pitch, const Vector<2>& at) {
  return (world_from_pitch * at.homogeneous()).head<2>();
}

std::vector<people::Post> goal_posts(const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch) {
  std::vector<people::Post> posts;
  for (const double x : {0.0, pitch.length}) {
    for (const double side : {-1.0, 1.0}) {
      const double y = pitch.width / 2 + side * (kGoalWidth + kPostWidth) / 2;
      posts.push_back({in_world(world_from_pitch, {x - kPostWidth / 2, y - kPostWidth / 2}),
                       in_world(world_from_pitch, {x + kPostWidth / 2, y + kPostWidth / 2}),
                       kGoalHeight,
                       {225, 226, 228}});
    }
  }
  return posts;
}

}  // namespace marey::simulate::match
