// One thread that waits for all sockets of a wire at once (poll), and one lock for what they share with whoever writes frames.
// Nothing under the lock ever waits for a client: sockets take what they take at once, the rest is queued.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "marey/stream/socket.h"

namespace marey::stream {

class Loop {
 public:
  /// What happened at a socket: it can be read, or written. Called under the lock.
  struct Events {
    bool readable = false, writable = false;
  };
  using Handler = std::function<void(Events)>;

  Loop();
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// The lock of everything that this loop's handlers touch. Who holds it may call what follows.
  std::mutex& mutex() { return mutex_; }

  /// Reading is always waited for. Before `start`, or under the lock.
  void watch(int descriptor, Handler handler);
  void forget(int descriptor);
  /// Writing is waited for as well, or not any more.
  void want_to_write(int descriptor, bool wanted);
  /// Reading is left out for a while: a listener that cannot have another socket.
  void rest(int descriptor, bool resting);
  /// Called ten times a second, under the lock.
  void on_tick(std::function<void()> tick) { tick_ = std::move(tick); }

  /// Not under the lock.
  void start();
  /// Waits for the thread's end. No handler is called after it.
  void stop();

 private:
  struct Watched {
    Handler handler;
    bool write = false, resting = false;
    std::uint64_t generation = 0;  // a descriptor that is closed may be another socket's a moment later
  };

  void run();
  void wake();

  std::mutex mutex_;
  std::map<int, Watched> watched_;
  std::uint64_t generation_ = 0;
  std::function<void()> tick_;
  Descriptor waker_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace marey::stream
