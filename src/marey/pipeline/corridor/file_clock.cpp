// The clock of files: cameras are waited for, side by side, and nothing is dropped.
#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/pipeline/corridor/frame_grouping.h"

namespace marey::pipeline::corridor {
namespace {

constexpr int kDetectedAtOnce = 4;  // frames that a camera that detects is asked for

double file_rate(const std::vector<Feed>& feeds, ClockOptions::Pace pace) {
  if (pace == ClockOptions::Pace::first_camera && !feeds.empty()) return feeds.front().rate_hz();
  double rate = 0;
  for (const Feed& feed : feeds) rate = std::max(rate, feed.info().rate_hz.value_or(feed.has_images() ? kDefaultRate : 0));
  return rate;
}

class FileGrouping final : public FrameGrouping {
 public:
  FileGrouping(std::vector<Feed>&& feeds, const ClockOptions& options)
      : FrameGrouping(std::move(feeds), options, file_rate(feeds, options.pace)) {}

  std::optional<FrameSet> next() override {
    if (feeds_.empty() || (!begun_ && !begin()) || (is_even() && !start_)) return std::nullopt;
    const auto now = next_time();
    if (!now) return std::nullopt;
    FrameSet set;
    set.index = next_++;
    set.time = *now;
    for (std::size_t i = 0; i < lanes_.size(); ++i) set.cameras.push_back(take(i, *now));
    if (!is_even()) set.index = set.cameras.front()->frame.index;
    set.states = states();
    return set;
  }

  std::vector<FeedState> states() const override {
    std::vector<FeedState> states;
    for (const Feed& feed : feeds_) states.push_back(feed.state());
    return states;
  }

 private:
  bool is_even() const { return options_.pace == ClockOptions::Pace::even; }

  /// Reads the first frames. An even clock is set by the earliest of the cameras that run at its rate, so that synchronised cameras
  /// need not be moved.
  bool begin() {
    begun_ = true;
    if (!is_even()) return true;
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

  void read(std::size_t camera, Timestamp until, std::vector<CameraFrame>& read) {
    Lane& lane = lanes_[camera];
    const int at_once = feeds_[camera].detector() != nullptr ? kDetectedAtOnce : 1;
    Timestamp last = lane.waiting.empty() ? Timestamp::min() : lane.waiting.back().frame.time;
    while (!lane.ended && (last <= until || std::ssize(read) < at_once)) {
      auto frame = feeds_[camera].next();
      lane.ended = !frame;
      if (!frame) break;
      last = std::max(last, frame->frame.time);
      if (options_.interpolate) frame->frame.image = {};  // of detections between frames there is no image
      read.push_back(std::move(*frame));
    }
  }

  /// Reads on in every camera until a frame lies behind `until`, side by side.
  void fill(Timestamp until) {
    const auto needs_frames = [&](const Lane& lane) {
      return !lane.ended && (lane.waiting.empty() || lane.waiting.back().frame.time <= until);
    };
    if (std::none_of(lanes_.begin(), lanes_.end(), needs_frames)) return;
    std::vector<std::vector<CameraFrame>> got(lanes_.size());
    if (lanes_.size() == 1) {
      read(0, until, got[0]);
    } else {
      tbb::parallel_for(std::size_t{0}, lanes_.size(), [&](std::size_t i) {
        if (needs_frames(lanes_[i])) read(i, until, got[i]);
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

  /// When the next instant is; nothing at the end.
  std::optional<Timestamp> next_time() {
    if (is_even()) {
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

  bool all_over(Timestamp now) const {
    const Timestamp earliest = now - duration_from_seconds(kHalf / rate_hz_);
    return std::all_of(lanes_.begin(), lanes_.end(), [&](const Lane& lane) {
      return lane.ended && (lane.waiting.empty() || lane.waiting.back().frame.time < earliest);
    });
  }

  bool begun_ = false;
};

}  // namespace

std::unique_ptr<FrameGrouping> group_files(std::vector<Feed> feeds, const ClockOptions& options) {
  return std::make_unique<FileGrouping>(std::move(feeds), options);
}

}  // namespace marey::pipeline::corridor
