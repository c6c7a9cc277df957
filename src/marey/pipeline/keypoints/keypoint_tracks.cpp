#include "marey/pipeline/keypoints/keypoint_tracks.h"

#include <cstdint>

namespace marey::pipeline::keypoints {
namespace {

constexpr double kMaxDeviation_m = 0.15;  // a point known no better is not one

Sample sample_of_path(const reconstruct::keypoints::TrajectoryPoint& point, Provenance provenance) {
  Sample sample;
  sample.position = point.position;
  sample.velocity = point.velocity;
  sample.covariance = point.covariance;
  sample.provenance = provenance;
  sample.cameras = point.cameras;
  if (point.rays > 0) sample.residual_px = point.residual_px;
  return sample;
}

}  // namespace

void add_path(const std::vector<reconstruct::keypoints::TrajectoryPoint>& path, std::size_t first, std::size_t longest,
              TrackColumns& track) {
  std::vector<char> measured(path.size());
  for (std::size_t k = 0; k < path.size(); ++k) measured[k] = path[k].rays >= 2 ? 1 : 0;
  std::size_t k = 0;
  while (k < path.size() && measured[k] == 0) ++k;
  for (; k < path.size(); ++k) {
    std::size_t end = k;
    while (end < path.size() && measured[end] == 0) ++end;
    if (end == path.size()) return;
    const bool fill = end - k <= longest;
    for (; k <= end; ++k) {
      if (k < end && !fill) continue;
      if (path[k].covariance.trace() > 3 * kMaxDeviation_m * kMaxDeviation_m) continue;
      track.add(static_cast<std::int32_t>(first + k), sample_of_path(path[k], k < end ? Provenance::filled : Provenance::measured));
    }
    k = end;
  }
}

void add_instants(const reconstruct::keypoints::PersonTrack& person, std::size_t point, TrackColumns& track) {
  for (std::size_t k = 0; k < person.instants.size(); ++k) {
    const auto& points = person.instants[k].points;
    if (points.empty() || !points[point]) continue;
    Sample sample;
    sample.position = points[point]->position;
    sample.covariance = points[point]->covariance;
    sample.cameras = points[point]->used;
    if (points[point]->rays > 1) sample.residual_px = points[point]->residual_px;
    track.add(static_cast<std::int32_t>(person.first + k), sample);
  }
}

}  // namespace marey::pipeline::keypoints
