// What one client of the Qualisys protocol says and is answered, without a socket.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/net/server.h"
#include "marey/stream/qtm_packets.h"
#include "marey/stream/qtm_parameters.h"

namespace marey::stream {

/// What all clients share.
struct QtmState {
  const RecordingHeader* header = nullptr;
  const ChannelLayout* channel_layout = nullptr;
  bool allow_control = false;
  std::function<bool(bool on)> record;  ///< may be empty
  const void* master = nullptr;         ///< the session in control
  std::optional<Instant> newest;        ///< the last instant that was sent
  QtmEvent last_event = QtmEvent::connected;
};

class QtmSession : public net::Session {
 public:
  QtmSession(QtmState& state, net::Address client) : state_(&state), client_(client) {}
  ~QtmSession() override;

  void joined(net::Outbox& out) override;
  std::size_t received(std::string_view bytes, net::Outbox& out) override;
  /// The packets that answer a command, mostly one.
  std::vector<std::string> answer(std::string_view command);

  /// What it streams; nothing while it does not.
  const std::optional<QtmStreamRequest>& streaming() const { return streaming_; }
  /// Whether this instant is due to it; then it counts as given.
  bool is_due(const Instant& instant);
  /// Over UDP, where to.
  std::optional<net::Address> datagrams_to() const;

 private:
  std::vector<std::string> answer_known(const std::vector<std::string>& words);
  std::string version(const std::vector<std::string>& words);
  std::string parameters(const std::vector<std::string>& words) const;
  std::string current_frame(const std::vector<std::string>& words) const;
  std::string stream(const std::vector<std::string>& words);
  std::string control(const std::vector<std::string>& words);
  std::string as_master(const std::vector<std::string>& words);

  QtmState* state_;
  net::Address client_;
  int minor_ = 1;
  bool closing_ = false;
  std::optional<QtmStreamRequest> streaming_;
  std::int64_t detected_ = 0;
  std::optional<Timestamp> due_;
};

}  // namespace marey::stream
