// What a client of the Foxglove WebSocket may ask for.
#include "marey/core/error.h"
#include "marey/stream/foxglove_requests.h"

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    if (const auto request = marey::stream::foxglove_request(marey::fuzz::text_of(data, size)))
      marey::fuzz::check(request->subscribe.size() <= 256 && request->unsubscribe.size() <= 256);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");
  }
  return 0;
}
