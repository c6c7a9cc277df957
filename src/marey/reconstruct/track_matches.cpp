#include "marey/reconstruct/track_matches.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <tbb/parallel_for.h>

#include "marey/assign/no_index.h"

namespace marey::reconstruct {
namespace {

constexpr int kMaxCandidates = 3;    // blobs for a prediction in one image
constexpr std::size_t kTask = 1000;  // pairs of cameras and predictions: projections, or rays to intersect, that are worth a task

/// Cameras or predictions that make a task, where each has this many of the other.
std::size_t grain_of(std::size_t others) {
  return std::max<std::size_t>(1, kTask / std::max<std::size_t>(1, others));
}

template <typename Each>
void for_all(std::size_t count, std::size_t others, Each&& each) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain_of(others)), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) each(i);
  });
}

}  // namespace

void TrackMatches::match(const FrameRays& frame, std::span<const Track<3>> expected, RayGroups& groups,
                         std::vector<std::optional<NoPoint>>& missed) {
  const auto cameras = static_cast<std::size_t>(frame.cameras());
  missed.assign(expected.size(), std::nullopt);
  if (expected.empty()) return;
  matched_.assign(expected.size() * cameras, assign::kNoIndex);
  in_camera_.resize(cameras);
  for_all(cameras, expected.size(), [&](std::size_t c) { match_in(frame, static_cast<int>(c), expected, in_camera_[c]); });
  if (first_.size() < expected.size()) first_.resize(expected.size());
  for_all(expected.size(), cameras, [&](std::size_t i) { intersect(frame, i, expected[i], first_[i]); });
  for (int i = 0; i < std::ssize(expected); ++i) missed[i] = location(frame, i, expected[i], groups);
}

/// One camera: the assignment of blobs to predictions that is the likeliest as a whole.
void TrackMatches::match_in(const FrameRays& frame, int camera, std::span<const Track<3>> expected, InCamera& work) {
  if (frame.first(camera) == frame.last(camera)) return;
  const int first = frame.first(camera);
  work.pairs.clear();
  const double noise = frame.largest_sigma(camera);
  const double gate = sigmas_ * sigmas_;
  work.contenders.assign(static_cast<std::size_t>(frame.last(camera) - first), 0);
  bool contested = false;
  for (int i = 0; i < std::ssize(expected); ++i) {
    const auto at = frame.camera(camera).project_with_jacobian(expected[i].position);
    if (!at) continue;
    Matrix<2> S = at->by_world * expected[i].covariance * at->by_world.transpose();
    S.diagonal().array() += noise * noise;
    const Matrix<2> information = S.inverse();
    const double radius = sigmas_ * std::sqrt(S.trace());
    int found = 0;
    const std::size_t before = work.pairs.size();
    frame.for_each_near(camera, at->pixel, radius, [&](int ray) {
      const Vector<2> error = frame.pixel(ray) - at->pixel;
      const double distance = error.dot(information * error);
      if (distance >= gate) return;
      work.pairs.push_back({i, ray - first, 1 + gate - distance});
      ++found;
      contested |= ++work.contenders[ray - first] > 1 || found > 1;
    });
    if (found > kMaxCandidates) work.pairs.resize(before);  // a guess among this many would take what is another's
  }
  const auto cameras = static_cast<std::size_t>(frame.cameras());
  const auto give = [&](int row, int column) { matched_[static_cast<std::size_t>(row) * cameras + camera] = first + column; };
  if (!contested) {
    for (const assign::GatedPair& pair : work.pairs) give(pair.row, pair.column);
    return;
  }
  const auto columns = work.assigner.assign(static_cast<int>(expected.size()), frame.last(camera) - first, work.pairs);
  for (int row = 0; row < std::ssize(expected); ++row) {
    if (columns[row] != assign::kNoIndex) give(row, columns[row]);
  }
}

/// The point of all rays that a prediction was given, as if none of them were taken by the time that it is placed.
void TrackMatches::intersect(const FrameRays& frame, std::size_t index, const Track<3>& expected, Intersected& result) const {
  const auto cameras = static_cast<std::size_t>(frame.cameras());
  result.list.clear();
  for (std::size_t c = 0; c < cameras; ++c) {
    const int ray = matched_[index * cameras + c];
    if (ray != assign::kNoIndex) result.list.add(frame, ray);
  }
  result.point = triangulator_(result.list.lines(), expected.position);
}

std::optional<NoPoint> TrackMatches::location(const FrameRays& frame, int index, const Track<3>& expected, RayGroups& groups) {
  Intersected& first = first_[static_cast<std::size_t>(index)];
  const std::span<const int> rays = first.list.rays();
  if (std::any_of(rays.begin(), rays.end(), [&](int ray) { return groups.taken(ray); })) {
    list_.clear();
    for (const int ray : rays) {
      if (!groups.taken(ray)) list_.add(frame, ray);
    }
    std::swap(first.list, list_);
    first.point = triangulator_(first.list.lines(), expected.position);
  }
  const RayList& list = first.list;
  const Triangulation& result = first.point;
  if (const auto* reason = std::get_if<NoPoint>(&result)) return *reason;
  const SpacePoint point = std::get<SpacePoint>(result);
  if (complete(frame, list, point, groups)) {
    const Triangulation again = triangulator_(better_.lines(), point.position);
    if (const auto* more = std::get_if<SpacePoint>(&again); more && more->rays > point.rays) {
      groups.add(better_.rays(), *more, index);
      return std::nullopt;
    }
  }
  groups.add(list.rays(), point, index);
  return std::nullopt;
}

/// Asks the cameras whose ray was wrong or missing for a blob where the others say that the marker is; whether there is one.
bool TrackMatches::complete(const FrameRays& frame, const RayList& list, const SpacePoint& point, const RayGroups& groups) {
  if (point.rays == frame.cameras()) return false;
  better_.clear();
  bool more = false;
  int k = 0;
  for (int c = 0; c < frame.cameras(); ++c) {
    bool has_ray = false;
    if (k < list.size() && list.lines()[k].camera == c) {
      has_ray = point.used >> k & 1;
      if (has_ray) better_.add(frame, list.rays()[k]);
      ++k;
    }
    if (has_ray || frame.first(c) == frame.last(c)) continue;
    const auto at = frame.camera(c).project_with_jacobian(point.position);
    if (!at) continue;
    const double sigma = frame.largest_sigma(c);
    const double spread = (at->by_world * point.covariance * at->by_world.transpose()).trace() / 2;
    double nearest = sigmas_ * std::sqrt(sigma * sigma + spread);
    int best = assign::kNoIndex;
    frame.for_each_near(c, at->pixel, nearest, [&](int ray) {
      const double distance = (frame.pixel(ray) - at->pixel).norm();
      if (distance < nearest && !groups.taken(ray)) nearest = distance, best = ray;
    });
    if (best == assign::kNoIndex) continue;
    better_.add(frame, best);
    more = true;
  }
  return more;
}

}  // namespace marey::reconstruct
