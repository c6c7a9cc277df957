#include "marey/source/live_source.h"

#include <deque>
#include <iterator>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace marey::source {
namespace {

class LiveReader final : public LiveSource {
 public:
  LiveReader(std::unique_ptr<Source> source, std::shared_ptr<LiveTime> time, int keep)
      : source_(std::move(source)), info_(source_->info()), time_(std::move(time)), keep_(static_cast<std::size_t>(keep)) {
    reader_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
  }

  const SourceInfo& info() const override { return info_; }

  std::vector<Frame> arrived() override {
    const std::lock_guard lock(mutex_);
    std::deque<Frame> all = std::exchange(waiting_, {});
    return {std::make_move_iterator(all.begin()), std::make_move_iterator(all.end())};
  }

  std::int64_t overrun() const override {
    const std::lock_guard lock(mutex_);
    return overrun_;
  }
  bool ended() const override {
    const std::lock_guard lock(mutex_);
    return ended_;
  }
  std::vector<std::string> warnings() const override {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }

 private:
  void read(const std::stop_token& stop) {
    std::optional<Duration> ahead;  // of the source's times, of the run's
    while (!stop.stop_requested()) {
      auto frame = source_->next();
      const std::lock_guard lock(mutex_);
      if (!frame) break;
      if (!ahead) ahead = time_->now() - frame->time;
      frame->time += *ahead;
      waiting_.push_back(std::move(*frame));
      if (waiting_.size() <= keep_) continue;
      waiting_.pop_front();
      ++overrun_;
    }
    const std::lock_guard lock(mutex_);
    warnings_ = source_->warnings();
    ended_ = true;
  }

  std::unique_ptr<Source> source_;  // the reader's alone
  SourceInfo info_;
  std::shared_ptr<LiveTime> time_;
  std::size_t keep_;
  mutable std::mutex mutex_;  // guards what follows
  std::deque<Frame> waiting_;
  std::int64_t overrun_ = 0;
  bool ended_ = false;
  std::vector<std::string> warnings_;
  std::jthread reader_;
};

}  // namespace

std::unique_ptr<LiveSource> read_live(std::unique_ptr<Source> source, std::shared_ptr<LiveTime> time, int keep) {
  return std::make_unique<LiveReader>(std::move(source), std::move(time), keep);
}

}  // namespace marey::source
