#include "pitch_size.h"

#include "command_line.h"

namespace marey::cli {

geometry::PitchSize parse_pitch_size(const std::string& text) {
  constexpr const char* form = "the pitch's size as LENGTHxWIDTH in m, as 105x68";
  const std::vector<double> sides = numbers_in(text, 'x', closed(0, 1000), form);
  if (sides.size() != 2) throw WrongUsage("\"{}\" is no size of a pitch; write {}", text, form);
  const geometry::PitchSize size{sides[0], sides[1]};
  if (!contains(closed(40, 130), size.length) || !contains(closed(42, 100), size.width))
    throw WrongUsage("a pitch of {} x {} m is none: the areas need 40 to 130 m by 42 to 100 m", size.length, size.width);
  return size;
}

}  // namespace marey::cli
