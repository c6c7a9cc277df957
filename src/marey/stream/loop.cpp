#include "marey/stream/loop.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>
#include <vector>

#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "marey/core/error.h"

namespace marey::stream {
namespace {

constexpr std::chrono::milliseconds kTick{100};

/// Signals are for the program's own threads.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

Loop::Loop() : waker_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (!waker_)
    throw Error("a stream: the system gives no more descriptors ({}); close programs, or raise ulimit -n", std::strerror(errno));
}

Loop::~Loop() {
  stop();
}

void Loop::watch(int descriptor, Handler handler) {
  watched_[descriptor] = {.handler = std::move(handler), .generation = ++generation_};
  wake();
}

void Loop::forget(int descriptor) {
  watched_.erase(descriptor);
}

void Loop::want_to_write(int descriptor, bool wanted) {
  const auto found = watched_.find(descriptor);
  if (found == watched_.end() || found->second.write == wanted) return;
  found->second.write = wanted;
  if (wanted && std::this_thread::get_id() != thread_.get_id()) wake();
}

void Loop::rest(int descriptor, bool resting) {
  if (const auto found = watched_.find(descriptor); found != watched_.end()) found->second.resting = resting;
}

void Loop::start() {
  const SignalsBlocked quiet;
  const std::scoped_lock lock(mutex_);  // a handler asks whose thread it is on: not before that is written
  thread_ = std::thread([this] { run(); });
}

void Loop::stop() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    wake();
  }
  thread_.join();
}

void Loop::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t done = ::write(waker_.get(), &one, sizeof one);  // a full counter wakes as well
}

void Loop::run() {
  std::vector<pollfd> waited;
  std::vector<std::uint64_t> generations;
  auto next_tick = std::chrono::steady_clock::now() + kTick;
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    waited.assign(1, {.fd = waker_.get(), .events = POLLIN, .revents = 0});
    generations.assign(1, 0);
    for (const auto& [descriptor, watched] : watched_) {
      const int events = (watched.resting ? 0 : POLLIN) | (watched.write ? POLLOUT : 0);
      waited.push_back(
          {.fd = watched.resting && !watched.write ? -1 : descriptor, .events = static_cast<short>(events), .revents = 0});
      generations.push_back(watched.generation);
    }
    lock.unlock();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next_tick - std::chrono::steady_clock::now());
    poll(waited.data(), waited.size(), static_cast<int>(std::max<std::int64_t>(0, left.count())));
    lock.lock();
    if (waited[0].revents != 0) {
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t got = ::read(waker_.get(), &count, sizeof count);
    }
    for (std::size_t i = 1; i < waited.size() && !stopping_; ++i) {
      if (waited[i].fd < 0 || waited[i].revents == 0) continue;
      const auto found = watched_.find(waited[i].fd);
      if (found == watched_.end() || found->second.generation != generations[i]) continue;
      const Handler handler = found->second.handler;  // may forget itself
      handler({.readable = (waited[i].revents & ~POLLOUT) != 0, .writable = (waited[i].revents & POLLOUT) != 0});
    }
    if (std::chrono::steady_clock::now() < next_tick) continue;
    next_tick = std::chrono::steady_clock::now() + kTick;
    if (tick_) tick_();
  }
}

}  // namespace marey::stream
