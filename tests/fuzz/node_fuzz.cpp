// What a camera node sends: any message is a frame, an answer, or one Error; a frame or answer that was understood is written as it
// was read.
#include <cmath>

#include "marey/core/error.h"
#include "marey/source/live/node_message.h"

#include "fuzz.h"

namespace live = marey::source::live;
using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view message = marey::fuzz::text_of(data, size);
  try {
    const live::NodeFrame frame = live::read_node_frame(message, "node");
    for (const marey::Detection& found : frame.detections.value_or(std::vector<marey::Detection>{}))
      check(found.centre.allFinite() && std::isfinite(found.area) && found.covariance.allFinite());
    check(live::message_of(frame) == message);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "node: ");
  }
  try {
    const live::NodeAnswer answer = live::read_node_answer(message, "node");
    for (const std::string& camera : answer.cameras) check(camera.find_first_of("/\\,=\"\n\x1b") == std::string::npos);
    const live::NodeAnswer again = live::read_node_answer(live::message_of(answer), "node");
    check(again.cameras == answer.cameras && again.now == answer.now && again.known == answer.known);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "node: ");
  }
  return 0;
}
