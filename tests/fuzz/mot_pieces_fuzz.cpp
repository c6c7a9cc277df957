// Detections a piece at a time: the same boxes and warnings as of the whole text, or an Error as well.
#include <optional>
#include <vector>

#include "marey/core/error.h"
#include "marey/format/tracks/mot.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace tracks = marey::format::tracks;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  const std::string& path = marey::fuzz::memory_file(text);
  std::optional<tracks::MotTable> whole;
  std::string stated;
  try {
    whole = tracks::parse_mot(text, path, tracks::MotKind::detections);
  } catch (const marey::Error& error) {
    stated = error.what();
    marey::fuzz::check_message(stated, path);
  }
  try {
    tracks::MotReader reader(path);
    std::vector<marey::LabelledBox> boxes;
    while (const auto piece = reader.next()) boxes.insert(boxes.end(), piece->begin(), piece->end());
    // Only the whole is looked over for a frame that is far from the others, and put in order.
    check(whole ? boxes.size() == whole->boxes.size() && reader.warnings() == whole->warnings
                : stated.find("a number must be wrong") != stated.npos);
  } catch (const marey::Error& error) {
    check(!whole && stated == error.what());
  }
  return 0;
}
