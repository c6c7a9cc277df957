// The bytes of the Qualisys real-time protocol, little endian: packets out, commands in. Layouts as the protocol's text and the MIT
// clients (qualisys_cpp_sdk, qtm-rt) have them; lengths in mm, angles in degrees.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/stream/channel_layout.h"

namespace marey::stream {

enum class QtmPacket : std::uint32_t { error = 0, command = 1, xml = 2, data = 3, no_more_data = 4, event = 6, discover = 7 };

enum class QtmEvent : std::uint8_t {
  connected = 1,
  capture_started = 3,
  capture_stopped = 4,
  settings_changed = 11,
  shutting_down = 12,
};

/// By its number on the wire.
enum class QtmComponent : std::uint32_t {
  points = 1,
  points_no_labels = 2,
  bodies = 5,
  bodies_euler = 6,
  points_residual = 9,
  points_no_labels_residual = 10,
  bodies_residual = 11,
  bodies_euler_residual = 12,
  skeletons = 18,
};

/// What a client asked a data packet to hold.
struct QtmComponents {
  std::vector<QtmComponent> required;  ///< in its order; what this program has
  bool global_skeletons = false;       ///< segments in the world's frame, not in their parents'
};

/// With a size before it.
std::string qtm_packet(QtmPacket kind, std::string_view body);
/// Of a text, which ends in NUL on the wire.
std::string qtm_text_packet(QtmPacket kind, std::string_view text);
std::string qtm_event_packet(QtmEvent event);

/// An instant as a data packet.
std::string qtm_data_packet(const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene, const Instant& instant,
                            const QtmComponents& components);

/// Roll, pitch and yaw in degrees, of R = Rx·Ry·Rz.
Vector<3> qtm_euler_degrees(const Matrix<3>& rotation);

/// A packet that a client sent.
struct QtmReceived {
  std::uint32_t type = 0;
  std::string_view body;  ///< of the bytes it was read from
  std::size_t size = 0;   ///< with its head
};
inline constexpr std::size_t kQtmMaxBytes = 16'384;
/// Nothing if it is not whole yet. Throws Error if its size is not one.
std::optional<QtmReceived> qtm_received(std::string_view bytes);

/// A command's words, in lower case: clients differ in case, in blanks at the end and in whether a NUL is there.
std::vector<std::string> qtm_words(std::string_view command);
/// "3D", "6DEuler", "Skeleton:global": nothing if a word is not a component; those that this program never has are omitted.
std::optional<QtmComponents> qtm_components(const std::vector<std::string>& words, std::size_t first);

/// `StreamFrames …`, understood.
struct QtmStreamRequest {
  bool stop = false;
  double frequency = 0;      ///< Hz; 0: all frames
  std::int64_t divisor = 1;  ///< every this many frames
  std::optional<std::uint16_t> udp_port;
  std::string udp_host;  ///< empty: the client's own
  QtmComponents components;
};
std::optional<QtmStreamRequest> qtm_stream_request(const std::vector<std::string>& words);

}  // namespace marey::stream
