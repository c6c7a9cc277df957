#include "marey/detect/keypoints/limb_swaps.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <string_view>

namespace marey::detect::keypoints {
namespace {

constexpr std::array<std::array<std::string_view, 6>, 2> kGroups{
    {{"hip", "knee", "ankle", "heel", "foot_index", "toe"}, {"shoulder", "elbow", "wrist", "pinky", "index", "thumb"}}};

std::size_t index_of(const KeypointSet& set, std::string_view name) {
  return static_cast<std::size_t>(std::find(set.points.begin(), set.points.end(), name) - set.points.begin());
}

const Keypoint<2>* point_at(const Keypoints<2>& body, std::size_t point) {
  return point < body.points.size() && body.points[point] ? &*body.points[point] : nullptr;
}

/// The middle of all that is known, and how far that reaches: the same whatever is mirrored.
struct Trunk {
  Vector<2> middle = Vector<2>::Zero();
  double height = 1;  ///< px
};

Trunk trunk_of(const Keypoints<2>& body, std::span<const std::pair<std::size_t, std::size_t>> roots) {
  Trunk trunk;
  int count = 0;
  for (const auto& [left, right] : roots) {
    for (const std::size_t point : {left, right}) {
      if (const Keypoint<2>* one = point_at(body, point)) trunk.middle += one->position, ++count;
    }
  }
  if (count > 0) trunk.middle /= count;
  for (const auto& one : body.points) {
    if (one) trunk.height = std::max(trunk.height, 2 * (one->position - trunk.middle).norm());
  }
  return trunk;
}

}  // namespace

LimbSwaps::LimbSwaps(const KeypointSet& set, const SwapOptions& options) : options_(options), mirrored_(set.mirrored) {
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    if (mirrored_[i] == static_cast<int>(i)) continue;
    for (std::size_t group = 0; group < groups_.size(); ++group) {
      const auto ends = [&](std::string_view end) { return set.points[i].ends_with(end); };
      if (std::none_of(kGroups[group].begin(), kGroups[group].end(), ends)) continue;
      groups_[group].push_back(i);
      break;
    }
  }
  roots_ = {std::pair(index_of(set, "left_hip"), index_of(set, "right_hip")),
            std::pair(index_of(set, "left_shoulder"), index_of(set, "right_shoulder"))};
}

/// What a state costs in one image.
double LimbSwaps::here(const Keypoints<2>& body, int state) const {
  double cost = options_.prior * ((state & 1) + (state >> 1));
  std::array<Vector<2>, 2> across;  // from the left to the right
  for (std::size_t i = 0; i < 2; ++i) {
    const Keypoint<2>* left = point_at(body, roots_[i].first);
    const Keypoint<2>* right = point_at(body, roots_[i].second);
    if (left == nullptr || right == nullptr) return cost;
    across[i] = right->position - left->position;
    if (across[i].squaredNorm() < 2 * (left->covariance.trace() + right->covariance.trace())) return cost;  // from the side
  }
  const bool opposite = across[0].dot(across[1]) < -0.5 * across[0].norm() * across[1].norm();
  const bool one_mirrored = state == 1 || state == 2;
  if (opposite != one_mirrored) cost += options_.facing;
  return cost;
}

/// What it costs that a group's points continued as they are called, and that they changed sides.
std::array<double, 2> LimbSwaps::step(const Keypoints<2>& before, const Keypoints<2>& now, std::size_t group, double step_s) const {
  const Trunk was = trunk_of(before, roots_), is = trunk_of(now, roots_);
  const double slack = options_.speed * is.height * step_s;
  std::array<double, 2> cost{};
  double weights = 0;
  for (const std::size_t point : groups_[group]) {
    const Keypoint<2>* here = point_at(now, point);
    if (here == nullptr) continue;
    const std::array<std::size_t, 2> earlier{point, static_cast<std::size_t>(mirrored_[point])};
    const Keypoint<2>* same = point_at(before, earlier[0]);
    const Keypoint<2>* other = point_at(before, earlier[1]);
    if (same == nullptr || other == nullptr) continue;
    const double weight = here->visibility * std::min(same->visibility, other->visibility);
    for (std::size_t side = 0; side < 2; ++side) {
      const Keypoint<2>& there = side == 0 ? *same : *other;
      const Vector<2> moved = (here->position - is.middle) - (there.position - was.middle);
      const double variance = (here->covariance.trace() + there.covariance.trace()) / 2 + slack * slack;
      cost[side] += weight * std::min(moved.squaredNorm() / (2 * variance), options_.maximum);
    }
    weights += weight;
  }
  for (double& one : cost) one = weights > 0 ? options_.together * one / weights : 0;
  return cost;
}

void LimbSwaps::add(const Keypoints<2>& body, double step_s) {
  Waiting next{.body = body, .cost = {}, .from = {}};
  const Waiting* before = !waiting_.empty() ? &waiting_.back() : last_ ? &*last_ : nullptr;
  std::array<std::array<double, 2>, 2> steps{};
  if (before != nullptr) steps = {step(before->body, body, 0, step_s), step(before->body, body, 1, step_s)};
  for (int state = 0; state < kStates; ++state) {
    double best = before == nullptr ? 0 : std::numeric_limits<double>::infinity();
    for (int from = 0; before != nullptr && from < kStates; ++from) {
      const auto changed = static_cast<std::size_t>(from ^ state);
      const double cost = before->cost[static_cast<std::size_t>(from)] + steps[0][changed & 1] + steps[1][changed >> 1];
      if (cost < best) best = cost, next.from[static_cast<std::size_t>(state)] = from;
    }
    next.cost[static_cast<std::size_t>(state)] = best + here(body, state);
  }
  const double minimum = *std::min_element(next.cost.begin(), next.cost.end());
  for (double& cost : next.cost) cost -= minimum;
  waiting_.push_back(std::move(next));
}

Keypoints<2> LimbSwaps::take() {
  assert(!waiting_.empty());
  const auto& end = waiting_.back().cost;
  int state = static_cast<int>(std::min_element(end.begin(), end.end()) - end.begin());
  for (std::size_t i = waiting_.size() - 1; i > 0; --i) state = waiting_[i].from[static_cast<std::size_t>(state)];
  Keypoints<2> result = named(waiting_.front().body, state);
  last_ = std::move(waiting_.front());
  waiting_.pop_front();
  return result;
}

Keypoints<2> LimbSwaps::named(const Keypoints<2>& body, int state) const {
  Keypoints<2> result = body;
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    if (((state >> group) & 1) == 0) continue;
    for (const std::size_t point : groups_[group]) result.points[point] = body.points[static_cast<std::size_t>(mirrored_[point])];
  }
  return result;
}

}  // namespace marey::detect::keypoints
