#include "marey/track/roster/gap_filler.h"

#include <algorithm>
#include <utility>

#include "marey/filter/bridge.h"

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

/// What the guesses miss the end by is bridged from nothing at the beginning.
void GapFiller::close(Gap& gap, const Guess& end, TrackId track) {
  const auto length = std::ssize(gap.guesses);
  if (length == 0 || length > longest_) return;
  const double duration = seconds(end.time - gap.detected);
  const Guess& last = gap.guesses.back();
  const Vector<3> miss = end.position - (last.position + last.velocity * seconds(end.time - last.time));
  Eigen::Matrix<double, 2, 3> missed;
  missed << miss.transpose(), (end.velocity - last.velocity).transpose();
  const filter::Bridge<filter::WhiteAcceleration, 3> bridge(Eigen::Matrix<double, 2, 3>::Zero(), 0, missed, duration);
  for (std::int64_t i = 0; i < length; ++i) {
    Instant* frame = frame_at(gap.first + i);
    if (frame == nullptr) continue;
    const Guess& guess = gap.guesses[static_cast<std::size_t>(i)];
    const Vector<3> position = guess.position + bridge.at(seconds(guess.time - gap.detected)).row(0).transpose();
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
