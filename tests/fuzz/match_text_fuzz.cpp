// Matches in the formats of vendors: whatever the files hold, reading them ends in a recording in order or in one Error. The
// input's first byte chooses the format; what comes behind the first zero byte is the second file, where there is one.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/match/ground_match.h"

#include "fuzz.h"

using marey::fuzz::check;

namespace {

marey::format::match::GroundMatch parse(unsigned which, std::string_view first, std::string_view second) {
  switch (which % 8) {
    case 0:
      return marey::format::match::parse_mot_world(first, "file", 25);
    case 1:
      return marey::format::match::parse_metrica(first, "file", second, "file", {});
    case 2:
      return marey::format::match::parse_tracab(first, "file", second, "file");
    case 3:
      return marey::format::match::parse_epts(first, "file", second, "file");
    case 4:
      return marey::format::match::parse_soccernet(first, "file", {});
    case 5:
      return marey::format::match::parse_sportec(first, "file", second, "file");
    case 6:
      return marey::format::match::parse_statsperform(first, "file", {});
    default: {
      marey::format::match::GroundMatch match;
      match.recording = marey::format::match::parse_ground(first, "file");
      return match;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const std::size_t end = text.find('\0');
  const std::string_view second = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  try {
    const marey::format::match::GroundMatch match = parse(data[0], text.substr(0, end), second);
    check(match.recording.header.rate_hz > 0 && match.pitch.length > 0 && match.pitch.width > 0);
    for (const marey::TrackColumns& track : match.recording.tracks()) {
      check(marey::number(track.id()) > 0);
      for (std::size_t row = 0; row < track.size(); ++row) {
        check(track.location(row).allFinite() && track.at()[row] >= 0);
        check(row == 0 || track.at()[row] > track.at()[row - 1]);
      }
    }
  } catch (const marey::Error& error) {
    const std::string_view message = error.what();
    check(message.starts_with("file") && message.find('\n') == std::string_view::npos);
  }
  return 0;
}
