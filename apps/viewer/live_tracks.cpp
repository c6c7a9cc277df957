#include "live_tracks.h"

namespace marey::viewer {
namespace {

constexpr double kGrowth = 0.05;  // of the extent's longest side: by this much it has to grow before the page fits it again

}  // namespace

bool LiveTracks::add(const Instant& instant) {
  const bool new_tracks = list(instant);
  const bool new_extent = extend(instant);
  if (new_tracks || new_extent) reported_ = extent_;
  return new_tracks || new_extent;
}

bool LiveTracks::list(const Instant& instant) {
  bool changed = false;
  for (const TrackName& name : instant.named) {
    tracks_.insert_or_assign(name.id, Listed{name, instant.time});
    changed = true;
  }
  for (const Sample& sample : instant.samples) {
    const auto [found, is_new] =
        tracks_.try_emplace(sample.track, Listed{TrackName{.id = sample.track, .label = {}, .team = {}}, {}});
    found->second.last = instant.time;
    changed |= is_new;
  }
  if (changed && tracks_.size() > kMaxUnnamed) forget(instant.time);
  return changed;
}

bool LiveTracks::extend(const Instant& instant) {
  for (const Sample& sample : instant.samples) {
    if (!sample.measured()) continue;
    if (!extent_) extent_ = Extent{sample.position, sample.position};
    extent_->low = extent_->low.cwiseMin(sample.position);
    extent_->high = extent_->high.cwiseMax(sample.position);
  }
  if (!extent_) return false;
  if (!reported_) return true;
  const double growth = std::max((reported_->low - extent_->low).maxCoeff(), (extent_->high - reported_->high).maxCoeff());
  return growth > kGrowth * (reported_->high - reported_->low).maxCoeff();
}

void LiveTracks::forget(Timestamp now) {
  std::erase_if(tracks_, [&](const auto& entry) {
    const auto& [name, last] = entry.second;
    return name.label.empty() && name.team.empty() && now - last > duration_from_seconds(kForgetS);
  });
}

std::vector<TrackName> LiveTracks::names() const {
  std::vector<TrackName> names;
  for (const auto& [id, listed] : tracks_) names.push_back(listed.name);
  return names;
}

}  // namespace marey::viewer
