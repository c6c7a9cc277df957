// ZeroMQ's sockets as nodes use them.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include <zmq.hpp>

#include "marey/core/stop.h"

namespace marey::source::live {

/// One for the whole process, for as long as anybody has it.
inline std::shared_ptr<zmq::context_t> node_context() {
  static std::mutex mutex;
  static std::weak_ptr<zmq::context_t> kept;
  const std::lock_guard lock(mutex);
  std::shared_ptr<zmq::context_t> context = kept.lock();
  if (context == nullptr) kept = context = std::make_shared<zmq::context_t>();
  return context;
}

/// Until one of them has something to be read, or for kStopSlice, or for `most`.
template <std::size_t count>
void wait_for_any(const std::array<std::reference_wrapper<zmq::socket_t>, count>& sockets, std::chrono::milliseconds most) {
  std::array<zmq::pollitem_t, count> items{};
  for (std::size_t i = 0; i < count; ++i) items[i] = {sockets[i].get(), 0, ZMQ_POLLIN, 0};
  try {
    zmq::poll(items.data(), count, std::min(most, kStopSlice));
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
  }
}

/// The next part of a message that has come; nothing where there is none.
inline std::optional<zmq::message_t> received(zmq::socket_t& socket) {
  zmq::message_t part;
  return socket.recv(part, zmq::recv_flags::dontwait) ? std::optional(std::move(part)) : std::nullopt;
}

/// The last part of the next message; nothing where none has come.
inline std::optional<zmq::message_t> last_part(zmq::socket_t& socket) {
  std::optional<zmq::message_t> part = received(socket);
  while (part && part->more()) part = received(socket);
  return part;
}

inline std::string_view text_in(const zmq::message_t& message) {
  return {message.data<char>(), message.size()};
}

}  // namespace marey::source::live
