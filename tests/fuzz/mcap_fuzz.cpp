// The summary of an MCAP file: facts, or one sentence.
#include "marey/core/error.h"
#include "marey/format/mcap/mcap.h"

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    marey::fuzz::check(marey::format::mcap::mcap_facts(marey::fuzz::text_of(data, size), "file").size() == 3);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "file: ");
  }
  return 0;
}
