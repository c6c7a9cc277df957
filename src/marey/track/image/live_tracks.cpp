#include "marey/track/image/live_tracks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/track_sample.h"
#include "marey/filter/bridge.h"

namespace marey::track::image {
namespace {

// Before anything is learned; bench/live shows the curves.
constexpr double kPriorFound = 8;   // gaps that closed
constexpr double kPriorLost = 8;    // and targets that did not come back
constexpr double kPriorGap = 0.25;  // s; mean length of those gaps
constexpr double kEvenOdds = 0.5;   // from which on it is likelier that there is a target than not
constexpr double kOffBy = 1.0 / 3;  // of a side; a box that is off by more overlaps the true one by less than half

/// That a Gaussian of this variance lies within ± `most`.
double within(double maximum, double variance) {
  return variance > 0 ? std::erf(maximum / std::sqrt(2 * variance)) : 1.0;
}

/// That the predicted box lies on the target.
double overlaps(const Track<2>& track) {
  if (!track.box) return 1;
  return within(kOffBy * track.box->width, track.covariance(0, 0)) * within(kOffBy * track.box->height, track.covariance(1, 1));
}

/// Place and box of a target.
using PositionAndBox = Eigen::Matrix<double, 1, 6>;

PositionAndBox position_and_box(const Vector<2>& location, const std::optional<Box>& box) {
  const Box known = box.value_or(Box{});
  return (PositionAndBox() << location.x(), location.y(), known.left, known.top, known.width, known.height).finished();
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

double GapSurvival::still_there(double unobserved) const {
  const auto bin = std::min(static_cast<std::size_t>(unobserved / kBin), found_.size() - 1);
  double longer = kPriorFound * std::exp(-unobserved / kPriorGap) + found_[bin] / 2;
  for (std::size_t i = bin + 1; i < found_.size(); ++i) longer += found_[i];
  return longer / (longer + kPriorLost + lost_);
}

void LiveTracks::add(std::int64_t index, Timestamp time, std::span<const Track<2>> tracks, std::vector<Frame> frames) {
  const std::optional<Timestamp> before = std::exchange(searched_, time);
  now_ = time;
  for (const Track<2>& track : tracks) {
    Detected& detected = detected_[track.id];
    detected.confirmed = detected.confirmed || track.confirmed;
    if (!track.measured()) continue;
    if (track.confirmed && detected.time && before && *detected.time < *before)
      survival_.found_again(seconds(time - *detected.time));
    detected.time = time;
  }
  time_steps_.push_back({index, time, {tracks.begin(), tracks.end()}, std::move(frames)});
}

void LiveTracks::add_unsearched(std::int64_t index, Timestamp time, std::span<const Track<2>> tracks, std::vector<Frame> frames) {
  now_ = time;
  time_steps_.push_back({index, time, {}, std::move(frames), false});
  for (const Track<2>& track : tracks) {
    if (detected_.contains(track.id)) time_steps_.back().tracks.push_back(track);
  }
}

std::optional<Instant> LiveTracks::next(bool all) {
  if (time_steps_.empty()) return std::nullopt;
  if (!all && seconds(*now_ - time_steps_.front().time) < delay_ - 1e-9) return std::nullopt;
  const TimeStep time_step = std::move(time_steps_.front());
  time_steps_.pop_front();
  Instant instant;
  instant.index = time_step.index;
  instant.time = time_step.time;
  instant.frames = time_step.frames;
  for (const Track<2>& track : time_step.tracks) {
    if (auto sample = reported(time_step, track)) instant.samples.push_back(std::move(*sample));
  }
  forget_lost(time_step);
  return instant;
}

/// A target is given up when it is in no later instant; as long as none of these was searched, that says nothing.
void LiveTracks::forget_lost(const TimeStep& reported) {
  const auto tracks = [](const TimeStep& time_step, TrackId id) { return find_track(time_step.tracks, id) != nullptr; };
  const bool searched_later =
      std::any_of(time_steps_.begin(), time_steps_.end(), [](const TimeStep& later) { return later.searched; });
  std::erase_if(detected_, [&](const auto& entry) {
    const TrackId id = entry.first;
    if (!searched_later && (!reported.searched || tracks(reported, id))) return false;
    if (std::any_of(time_steps_.begin(), time_steps_.end(), [&](const TimeStep& later) { return tracks(later, id); })) return false;
    if (entry.second.confirmed) survival_.lost();
    return true;
  });
}

std::optional<Sample> LiveTracks::reported(const TimeStep& time_step, const Track<2>& track) {
  Detected& detected = detected_.at(track.id);
  if (!detected.confirmed) return std::nullopt;
  if (track.measured()) {
    detected.reported = sample_of(track);
    detected.reported_time = time_step.time;
    return detected.reported;
  }
  if (auto sample = filled(time_step, track)) return sample;
  // As of the last search it has not been seen since.
  const double unobserved = detected.time && searched_ ? std::max(0.0, seconds(*searched_ - *detected.time)) : 0;
  if (survival_.still_there(unobserved) * overlaps(track) < kEvenOdds) return std::nullopt;
  return sample_of(track);
}

/// Between the observations before and after, where the later one has come already.
std::optional<Sample> LiveTracks::filled(const TimeStep& time_step, const Track<2>& track) const {
  const Detected& detected = detected_.at(track.id);
  if (!detected.reported || !detected.time || *detected.time <= time_step.time) return std::nullopt;
  for (const TimeStep& later : time_steps_) {
    const Track<2>* again = find_track(later.tracks, track.id);
    if (again == nullptr || !again->measured()) continue;
    const filter::Bridge<filter::RandomWalk, 6> gap(position_and_box(detected.reported->position.head<2>(), detected.reported->box),
                                                    0, position_and_box(again->position, again->box),
                                                    seconds(later.time - detected.reported_time));
    const PositionAndBox here = gap.at(seconds(time_step.time - detected.reported_time));
    Sample sample = sample_of(track);
    sample.provenance = Provenance::filled;
    sample.position.head<2>() = here.head<2>();
    if (detected.reported->box && again->box) sample.box = Box{here[2], here[3], here[4], here[5]};
    return sample;
  }
  return std::nullopt;
}

}  // namespace marey::track::image
