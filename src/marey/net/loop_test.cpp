#include "marey/net/loop.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "marey/net/socket.h"

namespace marey::net {
namespace {

using namespace std::chrono_literals;

TEST(Loop, PostsTasksAndWatchesUntilForgotten) {
  Loop loop;
  loop.start();
  Address at{.host = kLoopback, .port = 0};
  const Descriptor socket = datagrams_at(at, "test");
  std::atomic<int> came = 0, posted = 0;
  {
    const std::scoped_lock lock(loop.mutex());
    loop.watch(socket.get(), [&] {
      while (receive(socket, 100)) ++came;
      return true;
    });
  }
  const auto wait_for = [](const std::atomic<int>& count, int required) {
    for (int i = 0; i < 200 && count < required; ++i) std::this_thread::sleep_for(5ms);
    return count == required;
  };
  for (int i = 1; i <= 3; ++i) {
    send_to(socket, at, "x");
    EXPECT_TRUE(wait_for(came, i));
  }
  loop.post([&] { ++posted; });
  EXPECT_TRUE(wait_for(posted, 1));
  {
    const std::scoped_lock lock(loop.mutex());
    loop.forget(socket.get());
  }
  send_to(socket, at, "x");
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(came, 3);
}

}  // namespace
}  // namespace marey::net
