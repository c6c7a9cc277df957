#include "marey/reconstruct/ray_intersections.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "marey/assign/no_index.h"

namespace marey::reconstruct {
namespace {

constexpr double kMinSineOfAngle = 0.15;  // sine of the angle below which two rays give a place, but not for a third camera

}  // namespace

RayIntersections::RayIntersections(std::span<const Camera> cameras, double sigmas, const Triangulator& triangulator)
    : sigmas_(sigmas), triangulator_(triangulator) {
  for (int a = 0; a < std::ssize(cameras); ++a) {
    for (int b = a + 1; b < std::ssize(cameras); ++b) matchers_.emplace_back(cameras[a], a, cameras[b], b);
  }
  std::stable_sort(matchers_.begin(), matchers_.end(),
                   [](const EpipolarMatcher& p, const EpipolarMatcher& q) { return p.quality() > q.quality(); });
}

void RayIntersections::find(const FrameRays& frame, RayGroups& groups) {
  small_.clear();
  members_.clear();
  lonely_.clear();
  small_of_ray_.assign(static_cast<std::size_t>(frame.size()), assign::kNoIndex);
  for (EpipolarMatcher& matcher : matchers_) {
    pairs_.clear();
    matcher.match(frame, groups.taken(), sigmas_, pairs_);
    large_.clear();
    for (const EpipolarPair& pair : pairs_) propose(frame, pair, matcher, groups);
    settle(large_, groups);
  }
  settle(small_, groups);
}

/// Collects a ray from every camera that has one where the pair meets, and keeps the group if three and more agree.
void RayIntersections::propose(const FrameRays& frame, const EpipolarPair& pair, const EpipolarMatcher& cameras,
                               const RayGroups& groups) {
  if (small_of_ray_[pair.a] != assign::kNoIndex && small_of_ray_[pair.a] == small_of_ray_[pair.b]) return;  // it has been proposed
  extend(frame, pair, cameras, groups);
  if (list_.size() < 3) {
    lonely_.push_back(pair);
    return;
  }
  const Triangulation result = triangulator_(list_.lines(), pair.position);
  const auto* point = std::get_if<SpacePoint>(&result);
  if (!point || point->rays < 3) {
    lonely_.push_back(pair);
    return;
  }
  const bool large = point->rays > 3;
  Proposal proposal{*point, static_cast<int>(members_.size()), list_.size()};
  members_.insert(members_.end(), list_.rays().begin(), list_.rays().end());
  if (!large) {
    for (int i = 0; i < list_.size(); ++i) {
      if (point->used >> i & 1) small_of_ray_[list_.rays()[i]] = static_cast<int>(small_.size());
    }
  }
  (large ? large_ : small_).push_back(proposal);
}

void RayIntersections::extend(const FrameRays& frame, const EpipolarPair& pair, const EpipolarMatcher& cameras,
                              const RayGroups& groups) {
  list_.clear();
  const SightLine& a = frame.line(pair.a);
  const SightLine& b = frame.line(pair.b);
  // Noise of the meeting point, m: across the rays, and more along them the flatter they meet.
  const double across = std::hypot(a.sigma / a.scale() * a.depth(pair.position), b.sigma / b.scale() * b.depth(pair.position));
  const double spread = across / std::max(pair.crossing_sine, kMinSineOfAngle);
  for (int c = 0; c < frame.cameras(); ++c) {
    if (c == cameras.a()) list_.add(frame, pair.a);
    if (c == cameras.b()) list_.add(frame, pair.b);
    if (c == cameras.a() || c == cameras.b() || frame.first(c) == frame.last(c)) continue;
    const auto pixel = frame.camera(c).project(pair.position);
    if (!pixel || !frame.camera(c).in_image(*pixel)) continue;
    const double depth = (pair.position - frame.camera(c).centre()).norm();
    double nearest = sigmas_ * std::hypot(frame.largest_sigma(c), spread * frame.line(frame.first(c)).scale() / depth);
    int best = assign::kNoIndex;
    frame.for_each_near(c, *pixel, nearest, [&](int ray) {
      const double distance = (frame.pixel(ray) - *pixel).norm();
      if (distance < nearest && !groups.taken(ray)) nearest = distance, best = ray;
    });
    if (best != assign::kNoIndex) list_.add(frame, best);
  }
}

/// Gives rays to proposals, those of most rays first, then those that fit best; a proposal that comes too late gets nothing.
void RayIntersections::settle(std::vector<Proposal>& proposals, RayGroups& groups) {
  std::stable_sort(proposals.begin(), proposals.end(), [](const Proposal& p, const Proposal& q) {
    return p.point.rays != q.point.rays ? p.point.rays > q.point.rays : p.misfit() < q.misfit();
  });
  for (const Proposal& proposal : proposals) {
    const auto rays =
        std::span(members_).subspan(static_cast<std::size_t>(proposal.begin), static_cast<std::size_t>(proposal.count));
    bool free = true;
    for (std::size_t i = 0; i < rays.size(); ++i) free &= !(proposal.point.used >> i & 1) || !groups.taken(rays[i]);
    if (free) groups.add(rays, proposal.point);
  }
}

void RayIntersections::find_pairs(const FrameRays& frame, RayGroups& groups) {
  partners_.assign(static_cast<std::size_t>(frame.size()), 0);
  const auto free = [&](const EpipolarPair& pair) { return !groups.taken(pair.a) && !groups.taken(pair.b); };
  for (const EpipolarPair& pair : lonely_) {
    if (free(pair)) ++partners_[pair.a], ++partners_[pair.b];
  }
  for (const EpipolarPair& pair : lonely_) {
    if (!free(pair) || partners_[pair.a] != 1 || partners_[pair.b] != 1) continue;
    const std::array<int, 2> rays = {pair.a, pair.b};
    const std::array<SightLine, 2> lines = {frame.line(pair.a), frame.line(pair.b)};
    const Triangulation result = triangulator_(lines, pair.position);
    if (const auto* point = std::get_if<SpacePoint>(&result)) groups.add(rays, *point);
  }
}

}  // namespace marey::reconstruct
