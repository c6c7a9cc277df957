#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::stream {

/// What a client of the Foxglove WebSocket asks for, of what this program has.
struct FoxgloveRequest {
  struct Subscription {
    std::uint32_t id = 0;       ///< the client's
    std::uint64_t channel = 0;  ///< ours
  };
  std::vector<Subscription> subscribe;
  std::vector<std::uint32_t> unsubscribe;
};

/// Of a text message. Nothing for what asks for something else. Throws Error for what is not JSON, and for more than a few
/// hundred subscriptions.
std::optional<FoxgloveRequest> foxglove_request(std::string_view text);

/// RFC 4648, with padding: how schemas are advertised.
std::string base64(std::string_view bytes);

/// `{"op":"serverInfo",…}` and `{"op":"advertise",…}`, as texts.
std::string foxglove_server_info(std::string_view name, std::string_view session);
std::string foxglove_advertisement();
/// A sentence for the user: level 0 informs, 1 warns.
std::string foxglove_status(int level, std::string_view message_text);

/// What stands before a message of a subscription: opcode 1, its id, ns.
std::string foxglove_data_head(std::uint32_t subscription, std::uint64_t time_ns);

}  // namespace marey::stream
