#include "marey/source/live_time.h"

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace marey::source {
namespace {

constexpr std::chrono::milliseconds kWait{2};

class SteadyTime final : public LiveTime {
 public:
  Timestamp now() override { return Timestamp(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - begin_)); }
  void wait() override {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, kWait, [this] { return woken_; });
    woken_ = false;
  }
  void wake() override {
    {
      const std::lock_guard lock(mutex_);
      woken_ = true;
    }
    came_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  bool woken_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

std::shared_ptr<LiveTime> steady_time() {
  return std::make_shared<SteadyTime>();
}

}  // namespace marey::source
