// An edit as somebody writes it, on the command line, in a script or from a page; and what a take that somebody sends says of one:
// its operation, a line feed, its payload.
#include <optional>

#include "marey/core/error.h"
#include "marey/edit/operation.h"
#include "marey/edit/request.h"
#include "marey/files/text_safety.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace edit = marey::edit;

namespace {

void read_request(std::string_view text) {
  try {
    const edit::Request request = edit::parse_request(text);
    check(!request.tracks.empty() && request.label == marey::plain_text(request.label));
    check(!request.frames || (request.frames->first >= 0 && request.frames->first <= request.frames->last));
    check(request.longest_s > 0 && request.within_m > 0 && (!request.cutoff_hz || *request.cutoff_hz > 0));
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");
  }
}

void read_kept(std::string_view text) {
  const std::size_t line = std::min(text.find('\n'), text.size());
  const marey::Edit kept{.id = 1,
                         .parent = {},
                         .operation = std::string(text.substr(0, line)),
                         .payload = std::string(text.substr(std::min(line + 1, text.size())))};
  try {
    const auto operation = edit::operation_of(kept);
    if (!operation) return;
    std::optional<edit::Operation> again;
    try {
      again = edit::operation_of(edit::edit_of(*operation));
    } catch (const marey::Error&) {
      check(false);
    }
    check(again == operation);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  read_request(text);
  read_kept(text);
  return 0;
}
