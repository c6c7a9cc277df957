#include "camera_distance.h"

#include "command_line.h"

namespace marey::cli {

std::optional<calibrate::wand::KnownDistance> distance_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto comma = text.find(','), equal = text.find('=');
  if (comma == std::string::npos || equal == std::string::npos || equal < comma) {
    throw WrongUsage("{}: write CAM1,CAM2=METRES, two cameras' names and how far they stand apart", text);
  }
  const double metres = number_in(text.substr(equal + 1), "m", above(0, 1e5));
  return calibrate::wand::KnownDistance{text.substr(0, comma), text.substr(comma + 1, equal - comma - 1), metres};
}

}  // namespace marey::cli
