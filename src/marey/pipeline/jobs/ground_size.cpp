#include "marey/pipeline/jobs/ground_size.h"

#include <sstream>

#include <fmt/core.h>

#include "marey/pipeline/jobs/numbers.h"

namespace marey::pipeline::jobs {

namespace {

constexpr Interval kLengths = closed(40, 130), kWidths = closed(42, 100);

geometry::PitchSize sides_of(const std::string& text, const char* what) {
  const std::string form = fmt::format("{} size as LENGTHxWIDTH in m, as 105x68", what);
  const std::vector<double> sides = numbers_in(text, 'x', closed(0, 1000), form);
  if (sides.size() != 2) throw WrongOption("\"{}\" is not a size; write {}", text, form);
  return {sides[0], sides[1]};
}

bool is_pitch(const geometry::PitchSize& size) {
  return contains(kLengths, size.length) && contains(kWidths, size.width);
}

}  // namespace

geometry::PitchSize parse_pitch_size(const std::string& text) {
  const geometry::PitchSize size = sides_of(text, "the pitch's");
  if (!is_pitch(size))
    throw WrongOption("a pitch of {} x {} m is not one: the areas need 40 to 130 m by 42 to 100 m", size.length, size.width);
  return size;
}

std::optional<geometry::PitchSize> parse_pitch_or_rectangle(const std::string& text) {
  const geometry::PitchSize size = sides_of(text, "the pitch's or the area's");
  if (!(size.length > 0 && size.width > 0)) throw WrongOption("an area of {} x {} m is not one", size.length, size.width);
  return is_pitch(size) ? std::optional(size) : std::nullopt;
}

std::vector<Vector<2>> parse_area(const std::string& text) {
  if (text.find('x') != std::string::npos) {
    const geometry::PitchSize size = sides_of(text, "the area's");
    if (!(size.length > 0 && size.width > 0)) throw WrongOption("an area of {} x {} m is not one", size.length, size.width);
    return {{0, 0}, {size.length, 0}, {size.length, size.width}, {0, size.width}};
  }
  constexpr const char* form = "an area's corners as \"x,y x,y x,y\" in m, three or more, or LENGTHxWIDTH";
  std::vector<Vector<2>> corners;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::vector<double> xy = numbers_in(word, ',', closed(-1e5, 1e5), form);
    if (xy.size() != 2) throw WrongOption("\"{}\" is no corner of an area; write {}", word, form);
    corners.emplace_back(xy[0], xy[1]);
  }
  if (corners.size() < 3) throw WrongOption("\"{}\" is not an area; write {}", text, form);
  return corners;
}

}  // namespace marey::pipeline::jobs
