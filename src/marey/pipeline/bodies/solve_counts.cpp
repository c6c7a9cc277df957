#include "marey/pipeline/bodies/solve_counts.h"

#include <algorithm>
#include <cmath>

#include "marey/geometry/median.h"

namespace marey::pipeline::bodies {

SolveCounts::SolveCounts(const Skeleton& skeleton)
    : skeleton_(&skeleton),
      markers_(skeleton.markers.size()),
      deviations_(skeleton.coordinates.size()),
      observed_(skeleton.coordinates.size()) {}

void SolveCounts::add(const solve::skeleton::SolvedPose& pose) {
  starts_ += pose.started ? 1 : 0;
  if (pose.detected == 0) {
    ++empty_;
    return;
  }
  for (std::size_t j = 0; j < markers_.size(); ++j) {
    if (!pose.residuals[j]) continue;
    ++markers_[j].detected;
    markers_[j].rms_m += *pose.residuals[j] * *pose.residuals[j];
    markers_[j].worst_m = std::max(markers_[j].worst_m, *pose.residuals[j]);
  }
  for (std::size_t c = 0; c < deviations_.size(); ++c) {
    deviations_[c].push_back(static_cast<float>(pose.deviations[c]));
    observed_[c] += pose.observed[c] ? 1 : 0;
  }
}

void SolveCounts::restart() {
  const std::int64_t starts = starts_;
  *this = SolveCounts(*skeleton_);
  starts_ = starts;
}

void SolveCounts::write(const SkeletonMotion& motion, SolveSummary& summary) {
  summary.starts = starts_;
  summary.empty = empty_;
  double sum = 0;
  std::int64_t count = 0;
  for (std::size_t j = 0; j < markers_.size(); ++j) {
    SolveSummary::Marker& marker = markers_[j];
    if (marker.detected == 0) continue;
    marker.label = skeleton_->markers[j].label;
    sum += marker.rms_m;
    count += marker.detected;
    marker.rms_m = std::sqrt(marker.rms_m / static_cast<double>(marker.detected));
    summary.worst_m = std::max(summary.worst_m, marker.worst_m);
    summary.markers.push_back(marker);
  }
  summary.skeleton_markers = static_cast<int>(markers_.size());
  const std::int64_t with_any = std::ssize(motion.rows) - empty_;
  summary.markers_a_frame = with_any > 0 ? static_cast<double>(count) / static_cast<double>(with_any) : 0;
  summary.rms_m = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
  for (std::size_t c = 0; c < skeleton_->coordinates.size(); ++c) {
    if (skeleton_->coordinates[c].free()) summary.coordinates.push_back(coordinate(c, motion));
  }
}

SolveSummary::Coordinate SolveCounts::coordinate(std::size_t c, const SkeletonMotion& motion) {
  SolveSummary::Coordinate stated{.name = skeleton_->coordinates[c].name, .is_rotation = skeleton_->coordinates[c].is_rotation};
  for (std::size_t r = 0; r < motion.rows.size(); ++r) {
    stated.lowest = r == 0 ? motion.rows[r][c] : std::min(stated.lowest, motion.rows[r][c]);
    stated.highest = r == 0 ? motion.rows[r][c] : std::max(stated.highest, motion.rows[r][c]);
  }
  std::vector<float>& all = deviations_[c];
  if (all.empty()) return stated;
  stated.deviation = geometry::median(all);
  stated.observed = static_cast<double>(observed_[c]) / static_cast<double>(all.size());
  return stated;
}

}  // namespace marey::pipeline::bodies
