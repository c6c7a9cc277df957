#include "marey/format/motion/length_unit.h"

#include <array>
#include <cctype>
#include <string>
#include <utility>

namespace marey::format::motion {

std::optional<double> metres_of_unit(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::array<std::pair<std::string_view, double>, 21> known{
      {{"mm", 0.001},   {"millimeter", 0.001}, {"millimeters", 0.001}, {"millimetre", 0.001}, {"millimetres", 0.001},
       {"cm", 0.01},    {"centimeter", 0.01},  {"centimeters", 0.01},  {"centimetres", 0.01}, {"dm", 0.1},
       {"m", 1},        {"meter", 1},          {"meters", 1},          {"metre", 1},          {"metres", 1},
       {"in", 0.0254},  {"inch", 0.0254},      {"inches", 0.0254},     {"ft", 0.3048},        {"foot", 0.3048},
       {"feet", 0.3048}}};
  for (const auto& [known_name, metres] : known) {
    if (lower == known_name) return metres;
  }
  return std::nullopt;
}

}  // namespace marey::format::motion
