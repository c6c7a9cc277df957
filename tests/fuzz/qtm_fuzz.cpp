// A client of the Qualisys protocol: whatever it sends is answered with whole packets, or its connection ends with a sentence.
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/stream/bytes.h"
#include "marey/stream/qtm_session.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace stream = marey::stream;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view bytes = marey::fuzz::text_of(data, size);
  static const marey::RecordingHeader header = [] {
    marey::RecordingHeader made;
    made.rate_hz = 100;
    made.bodies.resize(2);
    made.bodies[0].id = marey::BodyId(1);
    made.bodies[1].id = marey::BodyId(2);
    made.bodies[1].skeleton = "s";
    return made;
  }();
  stream::ChannelLayout channel_layout;
  channel_layout.begin(header);
  stream::QtmState state;
  state.header = &header;
  state.channel_layout = &channel_layout;
  state.allow_control = true;
  state.newest.emplace();
  stream::QtmSession session(state, {});
  try {
    while (const auto packet = stream::qtm_received(bytes)) {
      check(packet->size >= 8 && packet->size <= bytes.size());
      for (const std::string& reply : session.answer(packet->body))
        check(*stream::number_at<std::uint32_t>(reply, 0) == reply.size());
      session.is_due(*state.newest);
      bytes.remove_prefix(packet->size);
    }
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");
  }
  return 0;
}
