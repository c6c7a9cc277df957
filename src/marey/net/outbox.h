// The pending data for one client. Answers go out in order and are never dropped: a client that leaves more than `kMaxUnread`
// bytes of them unread is disconnected. Of frames the newest win: in a queue of `kMaxFrames` a new one takes the place of the
// oldest; with a queue for each topic, of one frame, it takes its turn as well.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace marey::net {

/// Of a WebSocket's message; a byte stream has no kinds.
enum class Kind : std::uint8_t { binary, text };

class Outbox {
 public:
  static constexpr std::size_t kMaxUnread = std::size_t{1} << 20;
  static constexpr std::size_t kMaxFrames = 4;  ///< with the one that is being sent

  /// A message of a WebSocket, or bytes of a stream: `head`, then `body`.
  struct Message {
    std::string head = {};
    std::shared_ptr<const std::string> body = nullptr;  ///< shared by all clients; may be none
    Kind kind = Kind::binary;

    std::string_view body_bytes() const { return body == nullptr ? std::string_view() : std::string_view(*body); }
    std::size_t size() const { return head.size() + body_bytes().size(); }
  };

  Outbox() = default;
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Only `head` counts as unread: a body is one answer to one request of HTTP.
  void answer(Message message);
  void answer(std::string bytes, Kind kind = Kind::binary) { answer({.head = std::move(bytes), .kind = kind}); }
  /// Into the queue of frames.
  void frame(Message message);
  /// Into the only place of its topic.
  void frame_of_topic(int topic, Message message);
  /// The connection is closed when all that waits has gone out.
  void end();

  std::int64_t frames_sent() const { return sent_; }
  std::int64_t frames_dropped() const { return dropped_; }

  // For the connection.
  /// Called when there is something to send, or the end was asked for.
  void on_change(std::function<void()> flush) { flush_ = std::move(flush); }
  /// The next message, which is being sent until `done`. Null if nothing waits.
  const Message* begin_next();
  /// The message that is being sent has gone out.
  void done();
  bool is_empty() const { return !sending_ && waiting_.empty(); }
  bool is_ending() const { return ending_; }
  bool is_overfull() const { return unread_ > kMaxUnread; }
  /// The client is gone; what waited was dropped.
  void discard();

 private:
  struct Waiting {
    Message message;
    bool is_frame = false;
    std::optional<int> topic = {};
  };

  void push(Waiting waiting);

  std::function<void()> flush_;
  std::deque<Waiting> waiting_;
  std::optional<Waiting> sending_;
  std::size_t frames_ = 0, unread_ = 0;  // with what is being sent
  bool ending_ = false, gone_ = false;
  std::int64_t sent_ = 0, dropped_ = 0;
};

}  // namespace marey::net
