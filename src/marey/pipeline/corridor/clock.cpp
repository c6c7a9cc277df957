#include "marey/pipeline/corridor/clock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

namespace marey::pipeline::corridor {
namespace {

constexpr double kFarthest = 60;    // px that a detection may move in a frame and still be found again
constexpr int kDetectedAtOnce = 4;  // frames that a camera that detects is asked for

std::optional<std::size_t> closest(const Vector<2>& place, const std::vector<Detection>& among) {
  std::optional<std::size_t> best;
  double least = kFarthest * kFarthest;
  for (std::size_t i = 0; i < among.size(); ++i) {
    const double distance = (among[i].centre - place).squaredNorm();
    if (distance < least) least = distance, best = i;
  }
  return best;
}

}  // namespace

std::vector<Detection> moved_to(Timestamp now, const CameraFrame& nearest, const CameraFrame& other) {
  std::vector<std::optional<std::size_t>> partner;
  for (const Detection& detection : *other.detections) partner.push_back(closest(detection.centre, *nearest.detections));
  const double share = seconds(now - nearest.frame.time) / seconds(other.frame.time - nearest.frame.time);
  std::vector<Detection> moved;
  for (std::size_t i = 0; i < nearest.detections->size(); ++i) {
    const Detection& detection = (*nearest.detections)[i];
    const auto found = closest(detection.centre, *other.detections);
    if (!found || partner[*found] != i) continue;
    moved.push_back(detection);
    moved.back().centre += share * ((*other.detections)[*found].centre - detection.centre);
  }
  return moved;
}

Clock::Clock(std::vector<Feed> feeds, const ClockOptions& options)
    : options_(options), feeds_(std::move(feeds)), lanes_(feeds_.size()) {
  if (options_.live) {
    options_.pace = ClockOptions::Pace::even;
    live_begin_ = options_.live->time->now();
  }
  if (options_.pace == ClockOptions::Pace::first_camera && !feeds_.empty()) {
    rate_hz_ = feeds_.front().rate_hz();
  } else {
    for (const Feed& feed : feeds_)
      rate_hz_ = std::max(rate_hz_, feed.info().rate_hz.value_or(feed.has_pictures() && !options_.live ? kUsualRate : 0));
    if (options_.live && rate_hz_ <= 0) rate_hz_ = kUsualRate;
  }
}

/// Reads the first frames. An even clock is set by the earliest of the cameras that run at its rate, so that cameras in step need
/// not be moved.
bool Clock::begin() {
  begun_ = true;
  if (options_.pace == ClockOptions::Pace::first_camera) return true;
  fill(Timestamp::min());
  double fastest = 0;
  std::optional<Timestamp> earliest;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i].waiting.empty()) continue;
    const double rate = feeds_[i].rate_hz();
    const Timestamp first = lanes_[i].waiting.front().frame.time;
    if (rate > fastest || (rate == fastest && first < *start_)) start_ = first;
    fastest = std::max(fastest, rate);
    earliest = earliest ? std::min(*earliest, first) : first;
  }
  if (!start_) return false;
  const double back = std::ceil(seconds(*start_ - *earliest) * rate_hz_ - 0.5);
  *start_ -= duration_from_seconds(back / rate_hz_);
  return true;
}

void Clock::read(std::size_t number, Timestamp until, std::vector<CameraFrame>& read) {
  Lane& lane = lanes_[number];
  const int at_once = feeds_[number].detector() != nullptr ? kDetectedAtOnce : 1;
  Timestamp last = lane.waiting.empty() ? Timestamp::min() : lane.waiting.back().frame.time;
  while (!lane.ended && (last <= until || std::ssize(read) < at_once)) {
    auto frame = feeds_[number].next();
    lane.ended = !frame;
    if (!frame) break;
    last = std::max(last, frame->frame.time);
    if (options_.interpolate) frame->frame.picture = {};  // of detections between frames there is no picture
    read.push_back(std::move(*frame));
  }
}

/// Reads on in every camera until a frame lies behind `until`, side by side.
void Clock::fill(Timestamp until) {
  const auto wanting = [&](const Lane& lane) {
    return !lane.ended && (lane.waiting.empty() || lane.waiting.back().frame.time <= until);
  };
  if (std::none_of(lanes_.begin(), lanes_.end(), wanting)) return;
  std::vector<std::vector<CameraFrame>> got(lanes_.size());
  if (lanes_.size() == 1) {
    read(0, until, got[0]);
  } else {
    tbb::parallel_for(std::size_t{0}, lanes_.size(), [&](std::size_t i) {
      if (wanting(lanes_[i])) read(i, until, got[i]);
    });
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    for (CameraFrame& frame : got[i]) {
      decoding_.add(frame.decode_s);
      detecting_.add(frame.detect_s);
      ++lanes_[i].frames;
      lanes_[i].waiting.push_back(std::move(frame));
    }
  }
}

/// When the next moment is; nothing when there is none.
std::optional<Timestamp> Clock::next_moment() {
  if (options_.pace == ClockOptions::Pace::even) {
    const Timestamp now = *start_ + duration_from_seconds(static_cast<double>(next_) / rate_hz_);
    fill(now + duration_from_seconds(1 / rate_hz_));
    if (all_over(now)) return std::nullopt;
    return now;
  }
  Lane& first = lanes_.front();
  if (first.waiting.empty()) {
    fill(Timestamp::min());
    if (first.waiting.empty()) return std::nullopt;
  }
  const Timestamp now = first.waiting.front().frame.time;
  if (lanes_.size() > 1) fill(now);
  return now;
}

bool Clock::all_over(Timestamp now) const {
  const Timestamp earliest = now - duration_from_seconds(kHalf / rate_hz_);
  return std::all_of(lanes_.begin(), lanes_.end(), [&](const Lane& lane) {
    return lane.ended && (lane.waiting.empty() || lane.waiting.back().frame.time < earliest);
  });
}

std::optional<FrameSet> Clock::next() {
  if (options_.live) return next_live();
  if (feeds_.empty() || (!begun_ && !begin()) || (options_.pace == ClockOptions::Pace::even && !start_)) return std::nullopt;
  const auto now = next_moment();
  if (!now) return std::nullopt;
  FrameSet set;
  set.index = next_++;
  set.time = *now;
  set.cameras.resize(lanes_.size());
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    set.cameras[i] = take(i, *now);
    if (!set.cameras[i]) ++lanes_[i].missed;
  }
  if (options_.pace == ClockOptions::Pace::first_camera) set.index = set.cameras.front()->frame.index;
  set.states = states();
  return set;
}

std::vector<FeedState> Clock::states() const {
  std::vector<FeedState> states;
  for (const Feed& feed : feeds_) states.push_back(options_.live ? feed.state(live_begin_, *options_.live) : feed.state());
  return states;
}

/// The camera's frame that is nearest to the moment, moved to it where that is wanted.
std::optional<CameraFrame> Clock::take(std::size_t number, Timestamp now) {
  Lane& lane = lanes_[number];
  auto& frames = lane.waiting;
  // One frame before the moment is kept, to tell motion from.
  while (frames.size() > 2 && frames[1].frame.time <= now) frames.pop_front();
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!options_.interpolate && lane.used && frames[i].frame.time <= *lane.used) continue;  // given already
    const double off = std::abs(seconds(frames[i].frame.time - now));
    if (off < least) least = off, nearest = i;
  }
  if (!nearest || least > kHalf / rate_hz_) return std::nullopt;
  CameraFrame frame = frames[*nearest];
  lane.used = frame.frame.time;
  if (!options_.interpolate) {
    frames.erase(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(*nearest) + 1);
    return frame;
  }
  const double period = 1 / (feeds_[number].rate_hz() > 0 ? feeds_[number].rate_hz() : rate_hz_);
  if (least <= kInStep * period) return frame;
  const bool early = frame.frame.time < now;
  for (const bool beyond : {early, !early}) {  // the frame on the moment's other side, else the one on this side
    if (beyond ? *nearest + 1 >= frames.size() : *nearest == 0) continue;
    const CameraFrame& other = frames[beyond ? *nearest + 1 : *nearest - 1];
    if (std::abs(seconds(other.frame.time - frame.frame.time)) > 1.5 * period) continue;
    frame.detections = moved_to(now, frame, other);
    return frame;
  }
  frame.detections->clear();
  return frame;
}

std::optional<std::int64_t> Clock::count() const {
  return feeds_.empty() ? std::nullopt : feeds_.front().info().frame_count;
}

bool Clock::can_rewind() const {
  return std::all_of(feeds_.begin(), feeds_.end(), [](const Feed& feed) { return feed.can_rewind(); });
}

Clock Clock::again() const {
  std::vector<Feed> feeds;
  for (const Feed& feed : feeds_) feeds.push_back(feed.again());
  ClockOptions options = options_;
  options.interpolate = false;
  return Clock(std::move(feeds), options);
}

std::vector<std::string> Clock::warnings() const {
  std::vector<std::string> all;
  for (const Feed& feed : feeds_) {
    for (std::string& warning : feed.warnings()) all.push_back(std::move(warning));
  }
  return all;
}

}  // namespace marey::pipeline::corridor
