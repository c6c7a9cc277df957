#include "marey/source/live_time.h"

#include <chrono>
#include <thread>

namespace marey::source {
namespace {

constexpr std::chrono::milliseconds kWait{2};

class SteadyTime final : public LiveTime {
 public:
  Timestamp now() override { return Timestamp(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - begin_)); }
  void wait() override { std::this_thread::sleep_for(kWait); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

std::shared_ptr<LiveTime> steady_time() {
  return std::make_shared<SteadyTime>();
}

}  // namespace marey::source
