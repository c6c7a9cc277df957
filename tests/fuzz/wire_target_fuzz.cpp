// What may stand behind --stream.
#include "marey/stream/protocols.h"

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const marey::stream::Target target = marey::stream::parse_target(marey::fuzz::text_of(data, size));
    marey::fuzz::check(!target.protocol.empty() && !target.host.empty());
  } catch (const marey::stream::WrongTarget& error) {
    marey::fuzz::check_message(error.what(), "\"");
  }
  return 0;
}
