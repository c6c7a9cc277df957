// The small parts that every reader and writer stands on: whatever a text holds, plain text is plain, a field reads back, a number
// is finite, and depth is found without a crash.
#include <cmath>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/nesting.h"
#include "marey/format/text_rows.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  const std::string plain = marey::plain_text(text);
  check(marey::plain_text(plain) == plain);
  const std::string field = marey::format::quoted_field(std::string(text));
  std::vector<std::string_view> fields;
  marey::format::split_fields(field, ',', fields);
  check(fields.size() == 1 && marey::format::unquoted(fields[0]) == plain);
  check(marey::xml_escaped(text).find('<') == std::string::npos);
  if (const auto number = marey::format::number_of(text)) check(std::isfinite(*number));
  if (const auto number = marey::format::whole_number_of(text)) check(std::abs(static_cast<double>(*number)) <= 9e15);
  for (const auto notation : {marey::format::Notation::toml, marey::format::Notation::json, marey::format::Notation::xml}) {
    try {
      marey::format::check_nesting(text, notation, "file");
    } catch (const marey::Error& error) {
      marey::fuzz::check_message(error.what(), "file:");
    }
  }
  return 0;
}
