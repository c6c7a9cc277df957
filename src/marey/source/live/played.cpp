#include "marey/source/live/played.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/source/read_ahead.h"

namespace marey::source::live {
namespace {

constexpr int kAhead = 8;  // frames, decoded on another thread
class Played final : public Connection {
 public:
  Played(std::function<std::unique_ptr<Source>()> open, const PlayOptions& options, LiveTime& time, std::stop_token stop)
      : open_(std::move(open)), options_(options), time_(time), stop_(std::move(stop)), source_(read_ahead(open_(), kAhead)) {
    info_ = source_->info();
    begin_ = options_.begin();
  }

  const SourceInfo& info() const override { return info_; }

  Came next(Shot& shot) override {
    while (!pending_) {
      pending_ = source_->next();
      if (pending_) break;
      if (!options_.loop || count_ == 0 || stop_.stop_requested()) return stop_.stop_requested() ? Came::nothing : Came::end;
      again();
    }
    const double period = 1 / info_.rate_hz.value_or(kDefaultRate);
    const Timestamp due = begin_ + pending_->time.time_since_epoch();
    if (!wait_until_due(due, time_, stop_)) return Came::nothing;
    last_ = pending_->time;
    shot.sequence = count_++;
    shot.taken = due;
    shot.given.frame = std::move(*std::exchange(pending_, std::nullopt));
    const bool too_late = seconds(time_.now() - due) > kMaxBehind * period;
    if (too_late && given_ > 0) return Came::nothing;  // its number is missing in those that follow
    ++given_;
    return Came::frame;
  }

 private:
  void again() {
    begin_ += last_.time_since_epoch() + duration_from_seconds(1 / info_.rate_hz.value_or(kDefaultRate));
    source_ = read_ahead(open_(), kAhead);
  }

  std::function<std::unique_ptr<Source>()> open_;
  PlayOptions options_;
  LiveTime& time_;
  std::stop_token stop_;
  std::unique_ptr<Source> source_;
  SourceInfo info_;
  Timestamp begin_{}, last_{};
  std::optional<Frame> pending_;
  std::int64_t count_ = 0, given_ = 0;
};

}  // namespace

bool wait_until_due(Timestamp due, LiveTime& time, const std::stop_token& stop) {
  const double rest = seconds(due - time.now());
  if (stop.stop_requested()) return false;
  const double slice = std::chrono::duration<double>(kStopSlice).count();
  if (rest > 0) std::this_thread::sleep_for(std::chrono::duration<double>(std::min(rest, slice)));
  return rest <= slice;
}

Connect play(std::function<std::unique_ptr<Source>()> open, const PlayOptions& options) {
  return [open = std::move(open), options](LiveTime& time, const std::stop_token& stop) -> std::unique_ptr<Connection> {
    return std::make_unique<Played>(open, options, time, stop);
  };
}

}  // namespace marey::source::live
