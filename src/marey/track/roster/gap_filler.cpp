#include "marey/track/roster/gap_filler.h"

#include <algorithm>
#include <utility>

namespace marey::track::roster {

Instant* GapFiller::frame_at(std::int64_t number) {
  const std::int64_t back = added_ - number;  // 1: the last one
  if (back < 1 || back > std::ssize(waiting_)) return nullptr;
  return &waiting_[static_cast<std::size_t>(std::ssize(waiting_) - back)];
}

void GapFiller::add(Instant frame, std::span<const Track<3>> tracks) {
  const Timestamp now = frame.time;
  waiting_.push_back(std::move(frame));
  ++added_;
  for (const Track<3>& track : tracks) {
    if (!track.confirmed) continue;
    if (track.measured()) {
      if (const auto gap = gaps_.find(track.id); gap != gaps_.end()) {
        close(gap->second, {now, track.position, track.velocity, track.covariance}, track.id);
        gaps_.erase(gap);
      }
      last_observed_[track.id] = now;
      continue;
    }
    const auto detected = last_observed_.find(track.id);
    if (detected == last_observed_.end()) continue;
    Gap& gap = gaps_.try_emplace(track.id, Gap{added_ - 1, detected->second, {}}).first->second;
    if (std::ssize(gap.guesses) > longest_) continue;  // nothing will fill it
    gap.guesses.push_back({now, track.position, track.velocity, track.covariance});
    if (std::ssize(gap.guesses) > predicted_) continue;
    Sample point;
    point.track = track.id;
    point.position = track.position;
    point.covariance = track.covariance;
    point.provenance = Provenance::predicted;
    waiting_.back().samples.push_back(point);
  }
}

/// With s from 0 to 1 through the gap, the miss at the end is made up for as 3 s² − 2 s³ of it, that of the velocity as s³ − s².
void GapFiller::close(Gap& gap, const Guess& end, TrackId track) {
  const auto length = std::ssize(gap.guesses);
  if (length == 0 || length > longest_) return;
  const double duration = seconds(end.time - gap.detected);
  const Guess& last = gap.guesses.back();
  const Vector<3> miss = end.position - (last.position + last.velocity * seconds(end.time - last.time));
  const Vector<3> miss_of_velocity = end.velocity - last.velocity;
  for (std::int64_t i = 0; i < length; ++i) {
    Instant* frame = frame_at(gap.first + i);
    if (frame == nullptr) continue;
    const Guess& guess = gap.guesses[static_cast<std::size_t>(i)];
    const double s = seconds(guess.time - gap.detected) / duration;
    const Vector<3> position = guess.position + s * s * (3 - 2 * s) * miss + s * s * (s - 1) * duration * miss_of_velocity;
    std::erase_if(frame->samples, [&](const Sample& point) { return point.track == track; });
    Sample point;
    point.track = track;
    point.position = position;
    point.provenance = Provenance::filled;
    frame->samples.push_back(point);
  }
}

std::optional<Instant> GapFiller::next() {
  if (waiting_.empty() || (!ended_ && std::ssize(waiting_) <= longest_ + 1)) return std::nullopt;
  Instant frame = std::move(waiting_.front());
  waiting_.pop_front();
  std::sort(frame.samples.begin(), frame.samples.end(), [](const Sample& a, const Sample& b) { return a.track < b.track; });
  return frame;
}

}  // namespace marey::track::roster
