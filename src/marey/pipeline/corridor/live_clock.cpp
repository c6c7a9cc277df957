// The clock of live cameras: which instants continue, and which are dropped (clock.h defines the policy).
#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/geometry/median.h"
#include "marey/pipeline/corridor/frame_grouping.h"

namespace marey::pipeline::corridor {
namespace {

constexpr std::size_t kKept = 16;     // frames of a camera that wait for their instants
constexpr double kCorrection = 0.05;  // of what the moments are off the frames, each time

double live_rate(const std::vector<Feed>& feeds) {
  double rate = 0;
  for (const Feed& feed : feeds) rate = std::max(rate, feed.info().rate_hz.value_or(0));
  return rate > 0 ? rate : kDefaultRate;
}

bool is_waited_for(FeedState state) {
  return state == FeedState::connecting || state == FeedState::live || state == FeedState::back;
}

class LiveGrouping final : public FrameGrouping {
 public:
  LiveGrouping(std::vector<Feed>&& feeds, const ClockOptions& options)
      : FrameGrouping(std::move(feeds), options, live_rate(feeds)), begin_(options.live->time->now()) {}

  std::optional<FrameSet> next() override {
    for (;;) {
      if (stop_.stop_requested()) return std::nullopt;
      const bool over = std::all_of(feeds_.begin(), feeds_.end(), [](const Feed& feed) { return feed.has_ended(); });
      gather();
      if (const auto index = ready()) {
        drop_before(*index);
        return frame_set(*index);
      }
      if (over) return std::nullopt;
      if (options_.waiting) options_.waiting();
      options_.live->time->wait();
    }
  }

  std::vector<FeedState> states() const override {
    std::vector<FeedState> states;
    for (const Feed& feed : feeds_) states.push_back(feed.state(begin_, *options_.live));
    return states;
  }

  std::optional<LiveDrops> drops() const override {
    LiveDrops all = drops_;
    for (const Feed& feed : feeds_) all.overrun += feed.health().overrun;
    return all;
  }

 private:
  FrameSet frame_set(std::int64_t index) {
    FrameSet set;
    set.index = index;
    set.time = time_of(index);
    set.states = states();
    for (std::size_t i = 0; i < lanes_.size(); ++i) set.cameras.push_back(take(i, set.time));
    tbb::parallel_for(std::size_t{0}, lanes_.size(), [&](std::size_t i) {
      if (set.cameras[i]) feeds_[i].search(*set.cameras[i]);
    });
    for (const auto& camera : set.cameras) {
      if (camera && camera->detections && !options_.interpolate) detecting_.add(camera->detect_s);
    }
    next_ = index + 1;
    forget_before(set.time);
    adjust_start(set);
    return set;
  }

  /// Takes in what has come; the first frame of all begins the instants.
  void gather() {
    std::vector<std::vector<CameraFrame>> came(feeds_.size());
    tbb::parallel_for(std::size_t{0}, feeds_.size(),
                      [&](std::size_t i) { came[i] = feeds_[i].arrived(*options_.live, options_.interpolate); });
    for (const auto& frames : came) {
      if (start_ || frames.empty()) continue;
      start_ = frames.front().frame.time;
      for (const auto& others : came) {
        if (!others.empty()) start_ = std::min(*start_, others.front().frame.time);
      }
    }
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      Lane& lane = lanes_[i];
      for (CameraFrame& frame : came[i]) {
        decoding_.add(frame.decode_s);
        if (options_.interpolate) detecting_.add(frame.detect_s);
        ++lane.frames;
        if (frame.frame.time < time_of(next_) - duration_from_seconds(kHalf / rate_hz_)) {
          ++drops_.late_frames;
          continue;
        }
        lane.waiting.push_back(std::move(frame));
      }
      for (; lane.waiting.size() > kKept; ++drops_.overrun) lane.waiting.pop_front();
    }
  }

  Timestamp time_of(std::int64_t index) const { return *start_ + duration_from_seconds(static_cast<double>(index) / rate_hz_); }

  /// Cameras synchronised that are faster than they say, or slower, would slip from one instant into the next by and by, not all at
  /// the same time: the instants follow them.
  void adjust_start(const FrameSet& set) {
    off_.clear();
    for (const auto& camera : set.cameras) {
      if (camera) off_.push_back(seconds(camera->frame.time - set.time));
    }
    if (off_.empty()) return;
    const double off = geometry::median(off_);
    if (std::abs(off) > kInStep / rate_hz_) *start_ += duration_from_seconds(kCorrection * off);
  }

  /// The instant that the newest frame belongs to.
  std::int64_t last_time_step() const {
    std::int64_t last = next_ - 1;
    for (const Lane& lane : lanes_) {
      if (lane.waiting.empty()) continue;
      const double after = seconds(lane.waiting.back().frame.time - *start_) * rate_hz_;
      last = std::max<std::int64_t>(last, std::llround(after));
    }
    return last;
  }

  bool has_frame_of(const Lane& lane, Timestamp now) const {
    return std::any_of(lane.waiting.begin(), lane.waiting.end(), [&](const CameraFrame& frame) {
      return std::abs(seconds(frame.frame.time - now)) <= kHalf / rate_hz_ && (!lane.used || frame.frame.time > *lane.used);
    });
  }

  /// Whether every camera that is waited for has given its frame of the instant, or one that comes after it.
  bool is_whole(std::int64_t index) const {
    const Timestamp now = time_of(index);
    const std::vector<FeedState> states = this->states();
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      const auto& waiting = lanes_[i].waiting;
      const bool passed = !waiting.empty() && waiting.back().frame.time > now;
      if (is_waited_for(states[i]) && feeds_[i].is_connected() && !passed && !has_frame_of(lanes_[i], now)) return false;
    }
    return true;
  }

  bool is_empty(std::int64_t index) const {
    const Timestamp now = time_of(index);
    return std::none_of(lanes_.begin(), lanes_.end(), [&](const Lane& lane) { return has_frame_of(lane, now); });
  }

  /// The instant that continues now: the newest whole one, else the newest one that is late.
  std::optional<std::int64_t> ready() const {
    if (!start_) return std::nullopt;
    std::optional<std::int64_t> late;
    const Timestamp due = options_.live->time->now() - duration_from_seconds(options_.live->late_s);
    for (std::int64_t index = last_time_step(); index >= next_; --index) {
      if (is_empty(index)) continue;
      if (is_whole(index)) return index;
      if (!late && time_of(index) <= due) late = index;
    }
    return late;
  }

  void drop_before(std::int64_t index) {
    for (std::int64_t gone = next_; gone < index; ++gone) {
      if (is_empty(gone)) {
        ++drops_.empty;
      } else if (is_whole(gone)) {
        ++drops_.superseded;
      } else {
        ++drops_.incomplete;
      }
    }
  }

  /// Frames that belong to instants that went by; one is kept where motion is distinguished from it.
  void forget_before(Timestamp now) {
    const Timestamp oldest = now - duration_from_seconds((kHalf + (options_.interpolate ? 1 : 0)) / rate_hz_);
    for (Lane& lane : lanes_) {
      while (!lane.waiting.empty() && lane.waiting.front().frame.time < oldest) lane.waiting.pop_front();
    }
  }

  std::stop_token stop_ = StopScope::current();
  Timestamp begin_;
  LiveDrops drops_;
  std::vector<double> off_;  // follow's
};

}  // namespace

std::unique_ptr<FrameGrouping> group_live(std::vector<Feed> feeds, const ClockOptions& options) {
  return std::make_unique<LiveGrouping>(std::move(feeds), options);
}

}  // namespace marey::pipeline::corridor
