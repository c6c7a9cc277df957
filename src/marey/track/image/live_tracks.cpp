#include "marey/track/image/live_tracks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/track_sample.h"

namespace marey::track::image {
namespace {

// Before anything is learned; bench/live shows the curves.
constexpr double kPriorFound = 8;   // gaps that closed
constexpr double kPriorLost = 8;    // and targets that did not come back
constexpr double kPriorGap = 0.25;  // s; mean length of those gaps
constexpr double kEvenOdds = 0.5;   // from which on it is likelier that there is a target than not
constexpr double kOffBy = 1.0 / 3;  // of a side; a box that is off by more overlaps the true one by less than half

/// That a Gaussian of this variance lies within ± `most`.
double within(double most, double variance) {
  return variance > 0 ? std::erf(most / std::sqrt(2 * variance)) : 1.0;
}

/// That the predicted box lies on the target.
double overlaps(const Track<2>& track) {
  if (!track.box) return 1;
  return within(kOffBy * track.box->width, track.covariance(0, 0)) * within(kOffBy * track.box->height, track.covariance(1, 1));
}

double between_values(double a, double b, double share) {
  return a + share * (b - a);
}

Box between_boxes(const Box& a, const Box& b, double share) {
  return {between_values(a.left, b.left, share), between_values(a.top, b.top, share), between_values(a.width, b.width, share),
          between_values(a.height, b.height, share)};
}

const Track<2>* find_track(std::span<const Track<2>> tracks, TrackId id) {
  const auto found =
      std::lower_bound(tracks.begin(), tracks.end(), id, [](const Track<2>& track, TrackId sought) { return track.id < sought; });
  return found != tracks.end() && found->id == id ? &*found : nullptr;
}

}  // namespace

void GapSurvival::found_again(double gap) {
  const auto bin = static_cast<std::size_t>(std::max(0.0, gap / kBin));
  found_[std::min(bin, found_.size() - 1)] += 1;
}

double GapSurvival::still_there(double unseen) const {
  const auto bin = std::min(static_cast<std::size_t>(unseen / kBin), found_.size() - 1);
  double longer = kPriorFound * std::exp(-unseen / kPriorGap) + found_[bin] / 2;
  for (std::size_t i = bin + 1; i < found_.size(); ++i) longer += found_[i];
  return longer / (longer + kPriorLost + lost_);
}

void LiveTracks::add(std::int64_t index, Timestamp time, std::span<const Track<2>> tracks, std::vector<Frame> frames) {
  const std::optional<Timestamp> before = std::exchange(searched_, time);
  now_ = time;
  for (const Track<2>& track : tracks) {
    Seen& seen = seen_[track.id];
    seen.confirmed = seen.confirmed || track.confirmed;
    if (!track.measured()) continue;
    if (track.confirmed && seen.time && before && *seen.time < *before) survival_.found_again(seconds(time - *seen.time));
    seen.time = time;
  }
  moments_.push_back({index, time, {tracks.begin(), tracks.end()}, std::move(frames)});
}

void LiveTracks::add_unsearched(std::int64_t index, Timestamp time, std::span<const Track<2>> tracks, std::vector<Frame> frames) {
  now_ = time;
  moments_.push_back({index, time, {}, std::move(frames), false});
  for (const Track<2>& track : tracks) {
    if (seen_.contains(track.id)) moments_.back().tracks.push_back(track);
  }
}

std::optional<Instant> LiveTracks::next(bool all) {
  if (moments_.empty()) return std::nullopt;
  if (!all && seconds(*now_ - moments_.front().time) < delay_ - 1e-9) return std::nullopt;
  const Moment moment = std::move(moments_.front());
  moments_.pop_front();
  Instant instant;
  instant.index = moment.index;
  instant.time = moment.time;
  instant.frames = moment.frames;
  for (const Track<2>& track : moment.tracks) {
    if (auto sample = told(moment, track)) instant.samples.push_back(std::move(*sample));
  }
  forget_lost(moment);
  return instant;
}

/// A target is given up when it is in no later instant; as long as none of these was searched, that says nothing.
void LiveTracks::forget_lost(const Moment& told) {
  const auto follows = [](const Moment& moment, TrackId id) { return find_track(moment.tracks, id) != nullptr; };
  const bool searched_later = std::any_of(moments_.begin(), moments_.end(), [](const Moment& later) { return later.searched; });
  std::erase_if(seen_, [&](const auto& entry) {
    const TrackId id = entry.first;
    if (!searched_later && (!told.searched || follows(told, id))) return false;
    if (std::any_of(moments_.begin(), moments_.end(), [&](const Moment& later) { return follows(later, id); })) return false;
    if (entry.second.confirmed) survival_.lost();
    return true;
  });
}

std::optional<Sample> LiveTracks::told(const Moment& moment, const Track<2>& track) {
  Seen& seen = seen_.at(track.id);
  if (!seen.confirmed) return std::nullopt;
  if (track.measured()) {
    seen.told = sample_of(track);
    seen.told_time = moment.time;
    return seen.told;
  }
  if (auto sample = filled(moment, track)) return sample;
  // As of the last search it has not been seen since.
  const double unseen = seen.time && searched_ ? std::max(0.0, seconds(*searched_ - *seen.time)) : 0;
  if (survival_.still_there(unseen) * overlaps(track) < kEvenOdds) return std::nullopt;
  return sample_of(track);
}

/// Between the observations before and after, where the later one has come already.
std::optional<Sample> LiveTracks::filled(const Moment& moment, const Track<2>& track) const {
  const Seen& seen = seen_.at(track.id);
  if (!seen.told || !seen.time || *seen.time <= moment.time) return std::nullopt;
  for (const Moment& later : moments_) {
    const Track<2>* again = find_track(later.tracks, track.id);
    if (again == nullptr || !again->measured()) continue;
    const double share = seconds(moment.time - seen.told_time) / seconds(later.time - seen.told_time);
    Sample sample = sample_of(track);
    sample.provenance = Provenance::filled;
    sample.position.head<2>() = seen.told->position.head<2>() + share * (again->position - seen.told->position.head<2>());
    if (seen.told->box && again->box) sample.box = between_boxes(*seen.told->box, *again->box, share);
    return sample;
  }
  return std::nullopt;
}

}  // namespace marey::track::image
