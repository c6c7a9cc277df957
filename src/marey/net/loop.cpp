#include "marey/net/loop.h"

#include <cerrno>
#include <cstring>

#include <boost/asio/post.hpp>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/net/locked_executor.h"

namespace marey::net {
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

[[noreturn]] void refuse_descriptors(const char* reason) {
  throw Error("a server: the system has no descriptors left ({}); close programs, or raise ulimit -n", reason);
}

std::unique_ptr<Loop::Parts> new_parts() {
  try {
    return std::make_unique<Loop::Parts>();
  } catch (const boost::system::system_error& error) {
    refuse_descriptors(error.what());
  }
}

}  // namespace

void Loop::Parts::wait_for(const std::shared_ptr<Watched>& one) {
  one->descriptor.async_wait(asio::posix::descriptor_base::wait_read, [this, one](const boost::system::error_code& failed) {
    if (failed || !one->readable) return;
    const std::function<bool()> readable = one->readable;  // may forget itself
    if (readable()) return wait_for(one);
    one->again.expires_after(kTick);
    one->again.async_wait([this, one](const boost::system::error_code& stopped) {
      if (!stopped) wait_for(one);
    });
  });
}

void Loop::Parts::wait_for_tick() {
  timer.expires_after(kTick);
  timer.async_wait([this](const boost::system::error_code& stopped) {
    if (stopped) return;
    if (tick) tick();
    wait_for_tick();
  });
}

Loop::Loop() : parts_(new_parts()) {}

Loop::~Loop() {
  stop();
  parts_->watched.clear();  // before Asio, which it is a part of
}

std::mutex& Loop::mutex() {
  return parts_->lock.mutex;
}

void Loop::watch(int descriptor, std::function<bool()> readable) {
  const int copy = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  if (copy < 0) refuse_descriptors(std::strerror(errno));
  try {
    const auto one = std::make_shared<Parts::Watched>(parts_->executor, copy, std::move(readable));
    parts_->watched[descriptor] = one;
    parts_->wait_for(one);
  } catch (const boost::system::system_error& error) {
    close(copy);
    refuse_descriptors(error.what());
  }
}

void Loop::forget(int descriptor) {
  const auto found = parts_->watched.find(descriptor);
  if (found == parts_->watched.end()) return;
  found->second->readable = nullptr;
  boost::system::error_code ignored;
  found->second->descriptor.close(ignored);
  found->second->again.cancel();
  parts_->watched.erase(found);
}

void Loop::on_tick(std::function<void()> tick) {
  parts_->tick = std::move(tick);
}

void Loop::post(std::function<void()> task) {
  asio::post(parts_->executor, std::move(task));
}

void Loop::start() {
  const SignalsBlocked quiet;
  {
    const std::scoped_lock lock(mutex());
    parts_->wait_for_tick();
  }
  parts_->thread = std::thread([this] { parts_->context.run(); });
}

void Loop::stop() {
  if (!parts_->thread.joinable()) return;
  parts_->context.stop();
  parts_->thread.join();
}

}  // namespace marey::net
