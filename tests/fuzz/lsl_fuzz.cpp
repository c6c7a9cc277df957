// What anybody on the network may ask of an outlet of Lab Streaming Layer, by datagram and by TCP.
#include <string>

#include "marey/core/error.h"
#include "marey/stream/lsl_messages.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace stream = marey::stream;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  static const std::string info = [] {
    stream::LslOutlet outlet;
    outlet.name = "Marey";
    outlet.uid = "uid-1";
    outlet.layout.labels = {"A"};
    return stream::lsl_info_xml(outlet, false);
  }();
  if (const auto search = stream::lsl_search(text)) {
    check(search->port > 0);
    stream::lsl_matches(info, search->query);
  }
  stream::lsl_matches(info, text);
  if (const auto answer = stream::lsl_time_answer(text, 1, 2)) check(answer->starts_with(" ") && answer->size() < 200);
  try {
    if (const auto request = stream::lsl_request(text)) check(request->size > 0 && request->size <= size);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");
  }
  return 0;
}
