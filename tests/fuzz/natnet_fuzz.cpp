// A client of NatNet: any datagram is understood or passed over, and what answers it is a datagram whose head tells its size.
#include "marey/stream/bytes.h"
#include "marey/stream/natnet_packets.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace stream = marey::stream;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = stream::natnet_received(marey::fuzz::text_of(data, size));
  check(message.has_value() == (size >= 4));
  if (!message) return 0;
  const std::string answer = stream::natnet_response(message->payload);
  check(*stream::number_at<std::uint16_t>(answer, 2) + 4u == answer.size());
  return 0;
}
