#include "marey/reconstruct/keypoints/one_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <tuple>
#include <utility>

#include <Eigen/LU>

namespace marey::reconstruct::keypoints {
namespace {

constexpr double kMaxDistance_m = 200;  // numerical: from the camera; rays beyond are near the horizon
constexpr double kMinSlope = 0.02;      // numerical: of a ray towards the ground, and of one towards the plane

/// Physical: how high points of a foot are when it stands; parts of names and m.
constexpr std::array<std::pair<std::string_view, double>, 5> kStandingHeights{
    {{"ankle", 0.08}, {"heel", 0.03}, {"big_toe", 0.02}, {"small_toe", 0.02}, {"foot_index", 0.02}}};

}  // namespace

PeopleBeforeCamera::PeopleBeforeCamera(const KeypointSet& set, const Camera& camera, int number, int cameras,
                                       const OneCameraOptions& options)
    : set_(set), camera_(camera), number_(number), cameras_(cameras), options_(options) {
  for (std::size_t i = 0; i < set_.points.size(); ++i) {
    const std::string_view name = set_.points[i];
    for (const auto& [part, height] : kStandingHeights) {
      if (name.ends_with(part)) (name.starts_with("left") ? left_ : right_).push_back({i, height});
    }
  }
}

std::optional<Vector<3>> PeopleBeforeCamera::foot_at(const Keypoints<2>& person, const std::vector<FootPoint>& foot) const {
  Vector<3> sum = Vector<3>::Zero();
  double count = 0;
  for (const FootPoint& one : foot) {
    const auto& point = person.points[one.point];
    if (!point || point->visibility * point->presence < options_.min_confidence) continue;
    const auto ray = camera_.ray(point->position);
    if (!ray || ray->direction.z() > -kMinSlope) continue;
    const double distance = (one.height_m - ray->origin.z()) / ray->direction.z();
    if (!(distance > 0) || distance > kMaxDistance_m) continue;
    sum += ray->origin + distance * ray->direction;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Vector<3>(sum.x() / count, sum.y() / count, 0);
}

std::optional<Vector<3>> PeopleBeforeCamera::stands_at(const Keypoints<2>& person) const {
  const auto left = foot_at(person, left_), right = foot_at(person, right_);
  if (!left || !right) return left ? left : right;
  if ((*left - *right).norm() <= options_.step_m) return Vector<3>((*left + *right) / 2);
  const Vector<3>& eye = camera_.centre();
  return (*left - eye).norm() < (*right - eye).norm() ? left : right;
}

/// Where the rays to the keypoints meet the vertical plane through `place` that faces the camera.
std::vector<std::optional<SpacePoint>> PeopleBeforeCamera::points_at(const Keypoints<2>& person, const Vector<3>& location) const {
  std::vector<std::optional<SpacePoint>> points(person.points.size());
  Vector<3> normal = camera_.centre() - location;
  normal.z() = 0;
  if (!(normal.norm() > 1e-3)) return points;
  normal.normalize();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!person.points[i]) continue;
    const auto ray = camera_.ray(person.points[i]->position);
    if (!ray) continue;
    const double towards = ray->direction.dot(normal);
    if (towards > -kMinSlope) continue;
    const double distance = (location - ray->origin).dot(normal) / towards;
    SpacePoint point;
    point.position = ray->origin + distance * ray->direction;
    const auto detected = camera_.project_with_jacobian(point.position);
    if (!detected) continue;
    // Across the view as the image says, along it as people are deep.
    const double scale = std::sqrt(detected->by_world.squaredNorm() / 2),
                 sigma_px = std::sqrt(person.points[i]->covariance.trace() / 2);
    const double across = sigma_px / std::max(1e-6, scale);
    point.covariance = across * across * Matrix<3>::Identity() +
                       options_.depth_sigma_m * options_.depth_sigma_m * ray->direction * ray->direction.transpose();
    point.used = std::uint64_t{1} << number_;
    point.rays = 1;
    points[i] = point;
  }
  return points;
}

/// Of each place whose it is: those nearest to where people were first. 0 where there is no place.
std::vector<int> PeopleBeforeCamera::numbers_of(std::span<const std::optional<Vector<3>>> locations) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // distance, known, place
  for (std::size_t k = 0; k < known_.size(); ++k) {
    for (std::size_t i = 0; i < locations.size(); ++i) {
      if (!locations[i]) continue;
      const double distance = (known_[k].location - *locations[i]).norm();
      if (distance < options_.gate_m + options_.speed_m_s * known_[k].unobserved_s) pairs.emplace_back(distance, k, i);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> numbers(locations.size(), 0);
  std::vector<char> taken(known_.size(), 0);
  for (const auto& [distance, k, i] : pairs) {
    if (taken[k] != 0 || numbers[i] != 0) continue;
    taken[k] = 1;
    numbers[i] = known_[k].id;
    known_[k].location = *locations[i];
    known_[k].unobserved_s = 0;
  }
  for (std::size_t i = 0; i < locations.size(); ++i) {
    if (!locations[i] || numbers[i] != 0) continue;
    numbers[i] = next_id_++;
    known_.push_back({.id = numbers[i], .location = *locations[i], .unobserved_s = 0});
  }
  return numbers;
}

const std::vector<LocatedPerson>& PeopleBeforeCamera::step(double seconds, std::span<const Keypoints<2>> people) {
  for (Known& known : known_) known.unobserved_s += seconds;
  std::erase_if(known_, [&](const Known& known) { return known.unobserved_s > options_.lost_s; });
  std::vector<std::optional<Vector<3>>> locations;
  for (const Keypoints<2>& person : people) locations.push_back(stands_at(person));
  const std::vector<int> numbers = numbers_of(locations);
  located_.clear();
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!locations[i]) continue;
    LocatedPerson& located = located_.emplace_back();
    located.id = numbers[i];
    located.views.assign(static_cast<std::size_t>(cameras_), -1);
    located.views[static_cast<std::size_t>(number_)] = static_cast<int>(i);
    located.mirrored.resize(static_cast<std::size_t>(cameras_));
    located.points = points_at(people[i], *locations[i]);
  }
  return located_;
}

}  // namespace marey::reconstruct::keypoints
