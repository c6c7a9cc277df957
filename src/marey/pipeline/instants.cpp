#include "marey/pipeline/instants.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"

namespace marey::pipeline {
namespace {

constexpr double kInStep = 0.02;  // of a frame: what moves no marker by more than noise
constexpr double kHalf = 0.505;   // of a frame
constexpr double kFarthest = 60;  // px that a blob may move in a frame and still be found again
constexpr int kAtOnce = 4;        // frames that a camera is asked for

}  // namespace

Instants::Instants(std::vector<std::unique_ptr<BlobFeed>> feeds, std::optional<double> rate_hz) {
  for (auto& feed : feeds) {
    rate_hz_ = std::max(rate_hz_, feed->rate_hz());
    lanes_.push_back({.feed = std::move(feed), .frames_waiting = {}});
  }
  if (rate_hz) rate_hz_ = *rate_hz;
  fill(Timestamp::min());
  // The clock is set by the earliest of the cameras that run at its rate, so that cameras in step need not be moved.
  double fastest = 0;
  for (const Lane& lane : lanes_) {
    if (lane.ended && lane.frames_waiting.empty()) continue;
    const double rate = lane.feed->rate_hz();
    const Timestamp first = lane.frames_waiting.front().time;
    if (rate > fastest || (rate == fastest && first < *start_)) start_ = first;
    fastest = std::max(fastest, rate);
  }
  if (!start_) return;
  Timestamp earliest = *start_;
  for (const Lane& lane : lanes_) {
    if (!lane.frames_waiting.empty()) earliest = std::min(earliest, lane.frames_waiting.front().time);
  }
  const double back = std::ceil(seconds(*start_ - earliest) * rate_hz_ - 0.5);
  *start_ -= duration_from_seconds(back / rate_hz_);
}

/// Reads on in every camera until a frame lies behind `until`, a few more at a time, side by side.
void Instants::fill(Timestamp until) {
  const auto wanting = [&](const Lane& lane) {
    return !lane.ended && (lane.frames_waiting.empty() || lane.frames_waiting.back().time <= until);
  };
  if (std::none_of(lanes_.begin(), lanes_.end(), wanting)) return;
  std::vector<std::vector<SeenBlobs>> read(lanes_.size());
  tbb::parallel_for(std::size_t{0}, lanes_.size(), [&](std::size_t i) {
    Lane& lane = lanes_[i];
    Timestamp last = lane.frames_waiting.empty() ? Timestamp::min() : lane.frames_waiting.back().time;
    while (!lane.ended && (last <= until || std::ssize(read[i]) < kAtOnce)) {
      auto frame = lane.feed->next();
      lane.ended = !frame;
      if (!frame) break;
      last = std::max(last, frame->time);
      read[i].push_back(std::move(*frame));
    }
  });
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    for (SeenBlobs& frame : read[i]) {
      decoding_.add(frame.decode_s);
      detecting_.add(frame.detect_s);
      ++lanes_[i].frames;
      lanes_[i].frames_waiting.push_back(std::move(frame));
    }
  }
}

const Instant* Instants::next() {
  if (!start_) return nullptr;
  const Timestamp now = *start_ + duration_from_seconds(static_cast<double>(next_) / rate_hz_);
  fill(now + duration_from_seconds(1 / rate_hz_));
  const Timestamp earliest = now - duration_from_seconds(kHalf / rate_hz_);
  const bool over = std::all_of(lanes_.begin(), lanes_.end(), [&](const Lane& lane) {
    return lane.ended && (lane.frames_waiting.empty() || lane.frames_waiting.back().time < earliest);
  });
  if (over) return nullptr;
  instant_.index = next_++;
  instant_.time = now;
  instant_.seen.clear();
  instant_.cameras = 0;
  for (Lane& lane : lanes_) take(lane, now);
  return &instant_;
}

void Instants::take(Lane& lane, Timestamp now) {
  auto& frames = lane.frames_waiting;
  const double period = lane.feed->rate_hz() > 0 ? 1 / lane.feed->rate_hz() : 1 / rate_hz_;
  // One frame before the instant is kept, to tell motion from.
  while (frames.size() > 2 && frames[1].time <= now) frames.pop_front();
  int nearest = -1;
  double way = std::numeric_limits<double>::infinity();
  for (int i = 0; i < std::ssize(frames); ++i) {
    const double off = std::abs(seconds(frames[i].time - now));
    if (off < way) way = off, nearest = i;
  }
  if (nearest < 0 || way > kHalf / rate_hz_) {
    ++lane.missed;
    return;
  }
  ++instant_.cameras;
  const SeenBlobs& frame = frames[nearest];
  if (way <= kInStep * period) {
    instant_.seen.insert(instant_.seen.end(), frame.blobs.begin(), frame.blobs.end());
    return;
  }
  const int beyond = frame.time < now ? nearest + 1 : nearest - 1;
  const int before = frame.time < now ? nearest - 1 : nearest + 1;
  for (const int other : {beyond, before}) {
    if (other < 0 || other >= std::ssize(frames) || std::abs(seconds(frames[other].time - frame.time)) > 1.5 * period) continue;
    add_moved(frame, frames[other], now);
    return;
  }
}

void Instants::add_moved(const SeenBlobs& nearest, const SeenBlobs& other, Timestamp now) {
  const auto closest = [](const Vector<2>& place, const std::vector<Observation<2>>& among) {
    int best = -1;
    double least = kFarthest * kFarthest;
    for (int i = 0; i < std::ssize(among); ++i) {
      const double distance = (among[i].value - place).squaredNorm();
      if (distance < least) least = distance, best = i;
    }
    return best;
  };
  partner_.clear();
  for (const Observation<2>& blob : other.blobs) partner_.push_back(closest(blob.value, nearest.blobs));
  const double share = seconds(now - nearest.time) / seconds(other.time - nearest.time);
  for (int i = 0; i < std::ssize(nearest.blobs); ++i) {
    const int found = closest(nearest.blobs[i].value, other.blobs);
    if (found < 0 || partner_[found] != i) continue;
    instant_.seen.push_back(nearest.blobs[i]);
    instant_.seen.back().value += share * (other.blobs[found].value - nearest.blobs[i].value);
  }
}

std::vector<std::string> Instants::warnings() const {
  std::vector<std::string> all;
  for (const Lane& lane : lanes_) {
    for (const std::string& warning : lane.feed->warnings()) all.push_back(warning);
  }
  return all;
}

}  // namespace marey::pipeline
