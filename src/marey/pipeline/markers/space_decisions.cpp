#include "marey/pipeline/markers/space_decisions.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marey::pipeline::markers {

void SpaceDecisions::add(const FrameSet& frames, const SpaceBlobs& blobs, const reconstruct::Correspondences& found,
                         std::span<const Track<3>> tracks) {
  labels_.give(tracks);
  Undecided& undecided = undecided_.emplace_back();
  undecided.instant.index = frames.index;
  undecided.instant.time = frames.time;
  undecided.instant.detected = blobs.recorded();
  for (const reconstruct::Located& located : found.points) {
    Point& point = undecided.points.emplace_back();
    point.sample.position = located.point.position;
    point.sample.covariance = located.point.covariance;
    point.sample.residual_px = located.point.residual_px;
    point.blobs.assign(located.detected.begin(), located.detected.end());
    for (const int i : point.blobs) point.sample.cameras |= mask_of(blobs.all()[static_cast<std::size_t>(i)].camera);
  }
}

Instant SpaceDecisions::decided(std::span<const Track<3>> tracks) {
  Undecided undecided = std::move(undecided_.front());
  undecided_.pop_front();
  Instant instant = std::move(undecided.instant);
  for (const Track<3>& track : tracks) {
    if (!track.confirmed) continue;
    label(track, instant);
    if (!track.observation) continue;
    Point& point = undecided.points[static_cast<std::size_t>(*track.observation)];
    point.sample.track = track.id;
    for (const int i : point.blobs) instant.detected[static_cast<std::size_t>(i)].track = track.id;
    squares_ += *point.sample.residual_px * *point.sample.residual_px;
    ++points_;
    instant.samples.push_back(std::move(point.sample));
  }
  return instant;
}

void SpaceDecisions::label(const Track<3>& track, Instant& instant) {
  const std::string& label = track.label.empty() ? labels_.of(track.id) : track.label;
  const auto [known, is_new] = reported_labels_.try_emplace(track.id);
  if (!is_new && known->second == label) return;
  known->second = label;
  instant.named.push_back({track.id, label, {}});
}

std::optional<double> SpaceDecisions::residual() const {
  if (points_ == 0) return std::nullopt;
  return std::sqrt(squares_ / static_cast<double>(points_));
}

void PredictedMarkers::add_to(Instant& instant, std::span<const Track<3>> tracks) {
  for (const Track<3>& track : tracks) {
    if (!track.confirmed) continue;
    if (track.observation) {
      observed_at_[track.id] = instant.time;
      continue;
    }
    const auto observed = observed_at_.find(track.id);
    if (observed == observed_at_.end()) continue;
    if (seconds(instant.time - observed->second) > max_s_) {
      observed_at_.erase(observed);
      continue;
    }
    Sample& sample = instant.samples.emplace_back();
    sample.track = track.id;
    sample.position = track.position;
    sample.covariance = track.covariance;
    sample.provenance = Provenance::predicted;
  }
  std::sort(instant.samples.begin(), instant.samples.end(), [](const Sample& a, const Sample& b) { return a.track < b.track; });
}

}  // namespace marey::pipeline::markers
