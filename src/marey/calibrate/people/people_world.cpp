#include "marey/calibrate/people/people_world.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <Eigen/Cholesky>

#include "marey/core/keypoint_sets.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::people {
namespace {

constexpr double kEyeHeight = 0.936, kAnkleHeight = 0.039;  // physical: of the stature (Drillis & Contini, 1966)
constexpr double kShoulderHeight = 0.818;                   // physical: the same
constexpr double kTallest = 0.8;        // unswept: quantile of the heights: people bend, and stand upright often
constexpr double kFootSigma = 0.02;     // unswept: statures, of a standing foot's height
constexpr double kUprightSigma = 0.04;  // unswept: rad, of the mean body's direction
constexpr int kRounds = 5;              // numerical, time against precision: of the floor's robust fit

/// The mean of those of these points that a body has.
std::optional<Vector<3>> middle(const Body3& body, const KeypointSet& set, std::initializer_list<std::string_view> names) {
  Vector<3> sum = Vector<3>::Zero();
  double count = 0;
  for (const std::string_view name : names) {
    const auto index = point_named(set, name);
    if (!index || !body.points[static_cast<std::size_t>(*index)]) continue;
    sum += *body.points[static_cast<std::size_t>(*index)];
    count += 1;
  }
  if (count == 0) return std::nullopt;
  return Vector<3>(sum / count);
}

std::optional<Vector<3>> mean_upright(const std::vector<Body3>& bodies, const KeypointSet& set) {
  Vector<3> up = Vector<3>::Zero();
  for (const Body3& body : bodies) {
    const auto low = middle(body, set, {"left_ankle", "right_ankle"}),
               high = middle(body, set, {"left_shoulder", "right_shoulder"});
    if (low && high && (*high - *low).norm() > 0) up += (*high - *low).normalized();
  }
  if (up.norm() < 1e-6) return std::nullopt;
  return Vector<3>(up.normalized());
}

double stature_of(const std::vector<Body3>& bodies, const KeypointSet& set, const Vector<3>& up) {
  std::map<int, std::vector<double>> by_person;
  for (const Body3& body : bodies) {
    const auto eyes = middle(body, set, {"left_eye", "right_eye"});
    const auto shoulders = middle(body, set, {"left_shoulder", "right_shoulder"});
    const auto ankles = middle(body, set, {"left_ankle", "right_ankle"});
    if (!ankles || !(eyes || shoulders)) continue;
    const double top = eyes ? kEyeHeight : kShoulderHeight;
    by_person[body.person].push_back(up.dot((eyes ? *eyes : *shoulders) - *ankles) / (top - kAnkleHeight));
  }
  std::vector<double>* most = nullptr;
  for (auto& [person, heights] : by_person) {
    if (most == nullptr || heights.size() > most->size()) most = &heights;
  }
  if (most == nullptr) return 0;
  const auto at = most->begin() + static_cast<std::ptrdiff_t>(kTallest * static_cast<double>(most->size() - 1));
  std::nth_element(most->begin(), at, most->end());
  return *at;
}

/// Of each body the lower ankle, which mostly stands, lowered to the sole.
std::vector<Vector<3>> standing_feet(const std::vector<Body3>& bodies, const KeypointSet& set, const Vector<3>& up,
                                     double stature) {
  std::vector<Vector<3>> feet;
  for (const Body3& body : bodies) {
    const auto left = middle(body, set, {"left_ankle"}), right = middle(body, set, {"right_ankle"});
    if (left && right) feet.push_back((up.dot(*left) < up.dot(*right) ? *left : *right) - kAnkleHeight * stature * up);
  }
  return feet;
}

struct Floor {
  Vector<3> up = Vector<3>::UnitZ();
  double level = 0;  ///< along `up`
};

/// The plane through the feet whose normal is near `up`; feet off it count less and less (Cauchy).
Floor floor_through(const std::vector<Vector<3>>& feet, const Vector<3>& up, double stature) {
  const Vector<3> x = up.unitOrthogonal(), y = up.cross(x);
  Vector<3> middle = Vector<3>::Zero();
  for (const Vector<3>& foot : feet) middle += foot / static_cast<double>(feet.size());
  std::vector<double> levels;
  for (const Vector<3>& foot : feet) levels.push_back(up.dot(foot));
  Vector<3> slope(0, 0, geometry::median(std::move(levels)) - up.dot(middle));  // of x, of y, and the level
  const double sigma = kFootSigma * stature;
  for (int round = 0; round < kRounds; ++round) {
    Matrix<3> normal = Matrix<3>::Zero();
    Vector<3> right = Vector<3>::Zero();
    normal(0, 0) = normal(1, 1) = 1 / (kUprightSigma * kUprightSigma);
    for (const Vector<3>& foot : feet) {
      const Vector<3> off = foot - middle, row(x.dot(off), y.dot(off), 1);
      const double error = (up.dot(off) - row.dot(slope)) / sigma, weight = 1 / (1 + error * error) / (sigma * sigma);
      normal += weight * row * row.transpose();
      right += weight * row * up.dot(off);
    }
    slope = normal.ldlt().solve(right);
  }
  Floor floor;
  floor.up = (up - slope[0] * x - slope[1] * y).normalized();
  floor.level = floor.up.dot(middle + slope[2] * up);
  return floor;
}

}  // namespace

std::optional<PeopleWorld> world_of(const std::vector<Body3>& bodies, const KeypointSet& set) {
  const auto up = mean_upright(bodies, set);
  if (!up) return std::nullopt;
  PeopleWorld world;
  world.height = stature_of(bodies, set, *up);
  if (!(world.height > 0)) return std::nullopt;
  const std::vector<Vector<3>> feet = standing_feet(bodies, set, *up, world.height);
  Vector<3> middle_of_all = Vector<3>::Zero();
  double count = 0;
  for (const Body3& body : bodies) {
    if (const auto ankles = middle(body, set, {"left_ankle", "right_ankle"})) middle_of_all += *ankles, count += 1;
  }
  middle_of_all /= count;
  Floor floor{*up, up->dot(middle_of_all) - kAnkleHeight * world.height};
  if (feet.size() >= 3) floor = floor_through(feet, *up, world.height);
  world.height = stature_of(bodies, set, floor.up);
  const Vector<3> z = floor.up, x = z.unitOrthogonal(), y = z.cross(x);
  Rigid3& moved = world.moved_from_world;
  moved.rotation << x.transpose(), y.transpose(), z.transpose();
  moved.translation = -(moved.rotation * middle_of_all);
  moved.translation.z() = -floor.level;
  return world;
}

}  // namespace marey::calibrate::people
