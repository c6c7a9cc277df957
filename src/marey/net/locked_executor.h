// Asio as this folder uses it. Included by its sources alone: Asio and Beast cost the compiler seconds.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/basic_waitable_timer.hpp>
#include <boost/asio/execution.hpp>
#include <boost/asio/execution_context.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/basic_stream_descriptor.hpp>
#include <boost/asio/prefer.hpp>
#include <boost/asio/query.hpp>
#include <boost/asio/require.hpp>
#include <boost/asio/wait_traits.hpp>

#include "marey/net/loop.h"

namespace marey::net {

namespace asio = boost::asio;

/// What all copies of one LockedExecutor share.
struct LoopLock {
  std::mutex mutex;
  bool in_handler = false;  ///< of the loop's thread, which alone uses it
};

/// An executor whose functions run under a mutex. Handlers of one socket then never run beside each other, nor beside another
/// thread that holds the mutex and begins to write: what a strand is for handlers, this is for them and the writer.
template <typename Inner>
class LockedExecutor {
 public:
  LockedExecutor(Inner inner, LoopLock* lock) : inner_(std::move(inner)), lock_(lock) {}

  template <typename Property, typename = std::enable_if_t<asio::can_query<const Inner&, Property>::value>>
  decltype(auto) query(const Property& property) const noexcept {
    return asio::query(inner_, property);
  }
  template <typename Property, typename = std::enable_if_t<asio::can_require<const Inner&, Property>::value>>
  auto require(const Property& property) const {
    return LockedExecutor<std::decay_t<decltype(asio::require(inner_, property))>>(asio::require(inner_, property), lock_);
  }
  template <typename Property, typename = std::enable_if_t<asio::can_prefer<const Inner&, Property>::value>>
  auto prefer(const Property& property) const {
    return LockedExecutor<std::decay_t<decltype(asio::prefer(inner_, property))>>(asio::prefer(inner_, property), lock_);
  }

  template <typename Function>
  void execute(Function&& function) const {
    asio::execution::execute(inner_, [lock = lock_, function = std::forward<Function>(function)]() mutable {
      if (lock->in_handler) return std::move(function)();  // called by a handler, in place
      const std::scoped_lock held(lock->mutex);
      lock->in_handler = true;
      std::move(function)();
      lock->in_handler = false;
    });
  }

  friend bool operator==(const LockedExecutor& a, const LockedExecutor& b) noexcept {
    return a.inner_ == b.inner_ && a.lock_ == b.lock_;
  }
  friend bool operator!=(const LockedExecutor& a, const LockedExecutor& b) noexcept { return !(a == b); }

 private:
  Inner inner_;
  LoopLock* lock_;
};

using Executor = LockedExecutor<asio::io_context::executor_type>;
using Tcp = asio::ip::tcp;
using Socket = asio::basic_stream_socket<Tcp, Executor>;
using Timer = asio::basic_waitable_timer<std::chrono::steady_clock, asio::wait_traits<std::chrono::steady_clock>, Executor>;

struct Loop::Parts {
  /// A descriptor of its own for the same socket, so that neither side's closing concerns the other.
  struct Watched {
    Watched(const Executor& executor, int number, std::function<bool()> handler)
        : descriptor(executor, number), again(executor), readable(std::move(handler)) {}

    asio::posix::basic_stream_descriptor<Executor> descriptor;
    Timer again;
    std::function<bool()> readable;
  };

  void wait_for(const std::shared_ptr<Watched>& watched);
  void wait_for_tick();

  LoopLock lock;
  std::map<int, std::shared_ptr<Watched>> watched;
  std::function<void()> tick;
  std::thread thread;
  // Destroyed before all else: the handlers that wait in it.
  asio::io_context context{1};
  Executor executor{context.get_executor(), &lock};
  Timer timer{executor};
};

}  // namespace marey::net
