// The bytes of NatNet 4.1, little endian: what OptiTrack's clients read. Layouts after the open clients (the Apache-2.0
// depacketiser in `natnetsdk`, the MIT `natnet` and `libmotioncapture`); metres, quaternions x y z w. The world's y is up, as
// Motive streams it: (x, y, z) with z up becomes (x, z, −y).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "marey/stream/channel_layout.h"
#include "marey/stream/stream_clock.h"

namespace marey::stream {

enum class NatNetMessage : std::uint16_t {
  connect = 0,
  server_info = 1,
  request = 2,
  response = 3,
  query_definitions = 4,
  definitions = 5,
  query_frame = 6,
  frame = 7,
  text = 8,
  disconnect = 9,
  keep_alive = 10,
  unknown = 100,
};

/// With its head. A payload beyond a datagram's 65,503 bytes makes an empty one: it cannot be sent.
std::string natnet_message(NatNetMessage message, std::string_view payload);

/// A client's datagram: nothing if it is not one.
struct NatNetReceived {
  NatNetMessage message = NatNetMessage::unknown;
  std::string_view payload;
};
std::optional<NatNetReceived> natnet_received(std::string_view datagram);

/// Answers connect. `group` is the multicast address; none where frames go to each client.
std::string natnet_server_info(std::uint16_t data_port, std::optional<std::uint32_t> group);
/// Answers a request such as "Bitstream": a text, or the number 0.
std::string natnet_response(std::string_view request);

/// What there is: the labelled markers as one set, bodies, skeletons.
std::string natnet_definitions(const ChannelLayout& channel_layout);
/// An instant.
std::string natnet_frame(const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene, const Instant& instant,
                         const FrameTimes& times);

inline constexpr std::string_view kNatNetMarkerSet = "Markers";

}  // namespace marey::stream
