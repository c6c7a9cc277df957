// One thread that waits for all sockets of a server (Asio), and one mutex for what its handlers share with the thread that writes
// frames. No handler under the mutex waits for a client: a socket takes the bytes that it can take, the rest is queued.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

namespace marey::net {

class Loop {
 public:
  /// Asio's part, for the sources of this folder: net/locked_executor.h.
  struct Parts;

  /// Throws Error if the system has no descriptors left.
  Loop();
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Held while a handler runs. The thread that holds it may call what follows and everything of the loop's servers.
  std::mutex& mutex();

  /// Calls `readable` under the mutex when the socket can be read, until `forget`. If it returns false, the next call is at least
  /// 100 ms later.
  void watch(int descriptor, std::function<bool()> readable);
  void forget(int descriptor);
  /// Called every 100 ms, under the mutex. Set before `start`, or under the mutex.
  void on_tick(std::function<void()> tick);
  /// Calls `task` on the loop's thread, under the mutex. From any thread; needs no mutex.
  void post(std::function<void()> task);

  // Not under the mutex.
  void start();
  /// Waits for the thread's end. No handler is called after it.
  void stop();

  Parts& parts() { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::net
