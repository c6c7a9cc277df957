#include "pitch_size.h"

#include <charconv>
#include <string_view>

#include "marey/core/error.h"

namespace marey::cli {

geometry::PitchSize parse_pitch_size(const std::string& text) {
  geometry::PitchSize size;
  const auto cross = text.find('x');
  const auto read = [](std::string_view part, double& value) {
    const auto [stop, failed] = std::from_chars(part.data(), part.data() + part.size(), value);
    return failed == std::errc() && stop == part.data() + part.size();
  };
  const std::string_view all = text;
  if (cross == std::string::npos || !read(all.substr(0, cross), size.length) || !read(all.substr(cross + 1), size.width))
    throw Error("\"{}\" is no size of a pitch; it must read LENGTHxWIDTH in m, as 105x68", text);
  if (!(size.length >= 40 && size.length <= 130 && size.width >= 42 && size.width <= 100))
    throw Error("a pitch of {} x {} m is none: the areas need 40 to 130 m by 42 to 100 m", size.length, size.width);
  return size;
}

}  // namespace marey::cli
