#include "marey/source/live/live_camera.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <iterator>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/source/live/device_clock.h"

namespace marey::source::live {
namespace {

class LiveCamera final : public LiveSource {
 public:
  LiveCamera(std::string name, Connect connect, std::shared_ptr<LiveTime> time, const KeepOptions& options)
      : options_(options), connect_(std::move(connect)), time_(std::move(time)) {
    info_.name = std::move(name);
    reader_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  SourceInfo info() const override {
    const std::lock_guard lock(mutex_);
    return info_;
  }
  std::vector<CameraFrame> arrived() override {
    const std::lock_guard lock(mutex_);
    std::deque<CameraFrame> all = std::exchange(waiting_, {});
    return {std::make_move_iterator(all.begin()), std::make_move_iterator(all.end())};
  }
  bool connected() const override {
    const std::lock_guard lock(mutex_);
    return health_.gives_frames();
  }
  bool ended() const override {
    const std::lock_guard lock(mutex_);
    return ended_;
  }
  CameraHealth health() const override {
    const std::lock_guard lock(mutex_);
    return health_;
  }
  void take_only(cv::Size size) override {
    const std::lock_guard lock(mutex_);
    if (info_.size.empty()) info_.size = size;
  }

 private:
  void run(const std::stop_token& stop) {
    const StopScope scope(stop);
    double retry = options_.first_retry_s;
    while (!stop.stop_requested() && !ended()) {
      const Timestamp begin = time_->now();
      try {
        const auto connection = connect_(*time_, stop);
        connect_to(*connection);
        if (options_.controls != nullptr) options_.controls->begin(*connection);
        read(*connection, stop);
      } catch (const Stopped&) {
        return;
      } catch (const std::exception& error) {
        disconnect(error.what());
      }
      if (seconds(time_->now() - begin) > 2 * options_.longest_retry_s) retry = options_.first_retry_s;
      if (!ended()) wait(retry, stop);
      retry = std::min(2 * retry, options_.longest_retry_s);
    }
  }

  void wait(double duration, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, stop, std::chrono::duration<double>(duration), [] { return false; });
  }

  void connect_to(const Connection& connection) {
    const SourceInfo& now = connection.info();
    const std::lock_guard lock(mutex_);
    if (info_.size.empty()) info_.size = now.size;
    if (!info_.rate_hz) info_.rate_hz = now.rate_hz;
    health_.state = FeedState::live;
    ++health_.connections;
    if (!connection.continues_numbers()) sequence_.reset();
    clock_.reset();
  }

  void disconnect(const std::string& why) {
    const std::lock_guard lock(mutex_);
    health_.state = FeedState::stalled;
    health_.trouble = why;
  }

  void read(Connection& connection, const std::stop_token& stop) {
    Timestamp last = time_->now();
    const double patience = std::max(options_.silent_s, 3 / std::max(1e-3, connection.info().rate_hz.value_or(kDefaultRate)));
    while (!stop.stop_requested()) {
      if (options_.controls != nullptr) options_.controls->apply(connection);
      Shot shot;
      const Came came = connection.next(shot);
      const Timestamp now = time_->now();
      if (came == Came::nothing) {
        if (seconds(now - last) > patience) throw Error("{}: gives no frames any more; it is opened again", info_.name);
        continue;
      }
      last = now;
      const std::lock_guard lock(mutex_);
      if (came == Came::end) {
        ended_ = true;
        health_.state = FeedState::ended;
        break;
      }
      if (came == Came::damaged) {
        ++health_.damaged;
        if (sequence_) ++*sequence_;  // it had a number too
      } else {
        take(std::move(shot), now);
      }
    }
    time_->wake();
  }

  /// With the mutex held.
  void take(Shot shot, Timestamp arrival) {
    if (shot.sequence) {
      if (sequence_ && *shot.sequence > *sequence_ + 1) health_.lost += *shot.sequence - *sequence_ - 1;
      sequence_ = shot.sequence;
    }
    const cv::Size size = shot.given.frame.image.size();
    if (info_.size.empty()) info_.size = size;
    if (!shot.given.frame.image.empty() && size != info_.size) {
      ++health_.damaged;
      health_.trouble = fmt::format("{}: its images have {} × {} px now, not {} × {}; set it back, or begin again", info_.name,
                                    size.width, size.height, info_.size.width, info_.size.height);
      return;
    }
    Timestamp taken = arrival;
    if (shot.device_time) taken = clock_.time_of(*shot.device_time, arrival);
    if (shot.taken) taken = std::min(arrival, *shot.taken);
    if (last_ && taken <= *last_) taken = *last_ + Duration(1000);
    last_ = taken;
    shot.given.frame.index = health_.frames++;
    shot.given.frame.time = taken;
    waiting_.push_back(std::move(shot.given));
    if (std::ssize(waiting_) > options_.keep) {
      waiting_.pop_front();
      ++health_.overrun;
    }
    time_->wake();
  }

  KeepOptions options_;
  Connect connect_;
  std::shared_ptr<LiveTime> time_;
  mutable std::mutex mutex_;  // guards what follows
  SourceInfo info_;
  CameraHealth health_;
  std::deque<CameraFrame> waiting_;
  DeviceClock clock_;
  std::optional<std::int64_t> sequence_;
  std::optional<Timestamp> last_;
  bool ended_ = false;
  std::jthread reader_;
};

}  // namespace

std::unique_ptr<LiveSource> keep_connected(std::string name, Connect connect, std::shared_ptr<LiveTime> time,
                                           const KeepOptions& options) {
  return std::make_unique<LiveCamera>(std::move(name), std::move(connect), std::move(time), options);
}

}  // namespace marey::source::live
