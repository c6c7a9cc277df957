// What a camera node sends: any message is a frame, an answer, controls, or one Error; a frame or answer that was understood is
// written as it was read. What a host asks: any text is a question about controls, or none.
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
      check(found.centre.allFinite() && std::isfinite(found.area) && (!found.covariance || found.covariance->allFinite()));
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
  try {
    if (const auto controls = live::read_node_controls(message, "node")) {
      for (const live::ControlRange& range : controls->has) check(std::isfinite(range.now) && range.minimum <= range.maximum);
      check(controls->refused.find('\x1b') == std::string::npos);
    }
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "node: ");
  }
  if (const auto question = live::read_node_question(message)) {
    check(!question->request || (std::isfinite(question->request->value) && question->request->value >= 0));
    check(live::read_node_question(live::text_of(*question)).has_value());
  }
  return 0;
}
