// Shares of a standing person's height: shoulders at 0.18 and hips at 0.52 below the crown (Drillis & Contini, "Body segment
// parameters", 1966); a number, 0.14 to 0.18 high, is in the middle of the back, and smaller on the chest.
#include "marey/detect/shirts/shirt_region.h"

#include <cmath>
#include <numbers>
#include <string_view>

#include "marey/core/keypoint_sets.h"

namespace marey::detect::shirts {
namespace {

constexpr double kTrunk = 0.34;          // physical: of the height, from shoulders to hips
constexpr double kNumberBelow = 0.32;    // of the height, below the crown
constexpr double kNumberOnTrunk = 0.41;  // physical: the same place between shoulders (0) and hips (1)
constexpr double kSide = 0.448;          // by definition: of the height; holds the widest of the crops (shirt_network.cpp)
constexpr double kMaxLean = 50 * std::numbers::pi / 180;  // physical: beyond, a trunk shows its shoulders rather than its back
constexpr double kMinVisible = 0.5;                       // by definition: likelier visible than hidden
constexpr double kMaxWidthOfHeight = 0.8;                 // physical: a standing person with the arms out to the sides is narrower

std::optional<Vector<2>> middle_of(const Keypoints<2>& body, const KeypointSet& set, std::string_view left,
                                   std::string_view right) {
  Vector<2> sum = Vector<2>::Zero();
  for (const std::string_view name : {left, right}) {
    const auto index = point_named(set, name);
    if (!index || static_cast<std::size_t>(*index) >= body.points.size()) return std::nullopt;
    const auto& point = body.points[static_cast<std::size_t>(*index)];
    if (!point || point->visibility < kMinVisible || point->presence < kMinVisible) return std::nullopt;
    sum += point->position / 2;
  }
  return sum;
}

std::optional<ShirtRegion> region_on_trunk(const Vector<2>& shoulders, const Vector<2>& hips) {
  const Vector<2> up = shoulders - hips;
  const double angle = std::atan2(up.x(), -up.y()), stature = up.norm() / kTrunk;
  if (std::abs(angle) > kMaxLean) return std::nullopt;
  return ShirtRegion{{.centre = shoulders - kNumberOnTrunk * up, .side = kSide * stature, .angle = angle}, stature};
}

}  // namespace

std::optional<ShirtRegion> shirt_region(const Box& box) {
  if (!(box.height > 0) || box.width > kMaxWidthOfHeight * box.height) return std::nullopt;
  const Vector<2> centre(box.left + box.width / 2, box.top + kNumberBelow * box.height);
  return ShirtRegion{{.centre = centre, .side = kSide * box.height, .angle = 0}, box.height};
}

std::optional<ShirtRegion> shirt_region(const Sample& sample, const std::optional<KeypointSet>& set) {
  if (sample.keypoints && set) {
    const auto shoulders = middle_of(*sample.keypoints, *set, "left_shoulder", "right_shoulder");
    const auto hips = middle_of(*sample.keypoints, *set, "left_hip", "right_hip");
    if (shoulders && hips) return region_on_trunk(*shoulders, *hips);
  }
  return sample.box ? shirt_region(*sample.box) : std::nullopt;
}

}  // namespace marey::detect::shirts
