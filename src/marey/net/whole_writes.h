// The stream below Beast's WebSocket: a write is always done at once. What the system does not take waits here, so that a thread
// that writes never waits and each frame is with the system, or counted as waiting, when the call returns. Only net/connection.cpp
// includes it.
#pragma once

#include <string>
#include <utility>

#include <boost/asio/async_result.hpp>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "marey/net/locked_executor.h"

namespace marey::net {

class WholeWrites {
 public:
  using executor_type = Executor;
  using next_layer_type = Socket;
  using Code = boost::beast::error_code;

  explicit WholeWrites(Socket socket) : socket_(std::move(socket)) {}

  executor_type get_executor() { return socket_.get_executor(); }
  Socket& next_layer() { return socket_; }
  const Socket& next_layer() const { return socket_; }

  /// Bytes wait for the system to take them.
  bool has_rest() const { return !rest_.empty(); }
  /// Gives the system what it takes of them now.
  void flush(Code& failed) {
    const std::size_t taken = socket_.write_some(asio::buffer(rest_), failed);
    if (is_busy(failed)) failed = {};
    rest_.erase(0, taken);
  }

  template <typename Buffers>
  std::size_t write_some(const Buffers& buffers, Code& failed) {
    const std::size_t size = asio::buffer_size(buffers), before = rest_.size();
    const std::size_t taken = before == 0 ? socket_.write_some(buffers, failed) : 0;
    if (is_busy(failed)) failed = {};
    if (failed || taken == size) return taken;
    rest_.resize(before + size);
    asio::buffer_copy(asio::buffer(rest_) + before, buffers);
    rest_.erase(before, taken);
    return size;
  }
  template <typename Buffers>
  std::size_t write_some(const Buffers& buffers) {
    Code failed;
    const std::size_t size = write_some(buffers, failed);
    if (failed) throw boost::system::system_error(failed);
    return size;
  }
  template <typename Buffers>
  std::size_t read_some(const Buffers& buffers, Code& failed) {
    return socket_.read_some(buffers, failed);
  }
  template <typename Buffers>
  std::size_t read_some(const Buffers& buffers) {
    return socket_.read_some(buffers);
  }

  template <typename Buffers, typename Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return socket_.async_read_some(buffers, std::forward<Handler>(handler));
  }
  /// Beast's own answers (to a ping, to a close). Its handler is called when nothing waits any more: a client that pings and reads
  /// nothing is not read either.
  template <typename Buffers, typename Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    Code failed;
    const std::size_t size = write_some(buffers, failed);
    return asio::async_initiate<Handler, void(Code, std::size_t)>(
        [this](auto own, Code code, std::size_t bytes) {
          const auto executor = asio::get_associated_executor(own, get_executor());
          asio::post(get_executor(), asio::bind_executor(executor, Emptied<decltype(own)>{*this, std::move(own), code, bytes}));
        },
        handler, failed, size);
  }

  friend void teardown(boost::beast::role_type role, WholeWrites& stream, Code& failed) {
    boost::beast::websocket::teardown(role, stream.socket_, failed);
  }
  template <typename Handler>
  friend void async_teardown(boost::beast::role_type role, WholeWrites& stream, Handler&& handler) {
    boost::beast::websocket::async_teardown(role, stream.socket_, std::forward<Handler>(handler));
  }

 private:
  static bool is_busy(const Code& failed) { return failed == asio::error::would_block || failed == asio::error::interrupted; }

  /// Calls its handler when nothing waits in the stream.
  template <typename Handler>
  struct Emptied {
    WholeWrites& stream;
    Handler handler;
    Code failed;
    std::size_t bytes;

    void operator()(const Code& wait_failed = {}) {
      if (!failed) failed = wait_failed;
      if (!failed && stream.has_rest()) stream.flush(failed);
      if (failed || !stream.has_rest()) return std::move(handler)(failed, bytes);
      stream.socket_.async_wait(Socket::wait_write, std::move(*this));
    }
  };

  Socket socket_;
  std::string rest_;
};

}  // namespace marey::net
