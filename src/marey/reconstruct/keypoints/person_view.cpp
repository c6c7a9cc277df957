#include "marey/reconstruct/keypoints/person_view.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <Eigen/LU>

namespace marey::reconstruct::keypoints {

std::optional<SightLine> line_of(const Camera& camera, int number, const Keypoint<2>& point, double noise) {
  const double sigma = noise * std::sqrt(std::sqrt(std::max(1e-12, point.covariance.determinant())));
  return sight_line(camera, number, point.position, std::max(1e-3, sigma));
}

PersonView view_of(const Camera& camera, int number, int index, const Keypoints<2>& person, double noise) {
  PersonView view{.camera = number, .index = index, .points = {}};
  view.points.reserve(person.points.size());
  for (const auto& point : person.points) view.points.push_back(point ? line_of(camera, number, *point, noise) : std::nullopt);
  return view;
}

std::vector<std::optional<Limb>> limbs_of(const KeypointSet& set) {
  std::vector<std::optional<Limb>> limbs(set.points.size());
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    if (set.mirrored[i] == static_cast<int>(i)) continue;
    const std::string_view name = set.points[i];
    const auto is_one_of = [&](std::initializer_list<std::string_view> parts) {
      return std::any_of(parts.begin(), parts.end(), [&](std::string_view part) { return name.ends_with(part); });
    };
    if (is_one_of({"elbow", "wrist", "thumb", "index", "pinky"})) limbs[i] = Limb::arms;
    if (is_one_of({"knee", "ankle", "heel", "toe"})) limbs[i] = Limb::legs;
  }
  return limbs;
}

}  // namespace marey::reconstruct::keypoints
