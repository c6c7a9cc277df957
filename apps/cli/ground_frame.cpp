#include "ground_frame.h"

namespace marey::cli {

Option add_ground_frame(Command& command, std::string& text, const std::string& meaning) {
  return command.text("--l-frame", text, meaning).check([](const std::string& given) { ground_frame_of(given); });
}

std::vector<Vector<3>> ground_frame_of(const std::string& text) {
  constexpr const char* form = "the markers' places on the ground in m, X,Y or X,Y,Z, with ; between them";
  std::vector<Vector<3>> frame;
  for (std::size_t at = 0; at <= text.size();) {
    const std::string part = text.substr(at, text.find(';', at) - at);
    const auto numbers = numbers_in(part, ',', closed(-1000, 1000), form);
    if (numbers.size() != 2 && numbers.size() != 3) throw WrongUsage("{}: write {}", part, form);
    frame.emplace_back(numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 0);
    at += part.size() + 1;
  }
  return frame;
}

}  // namespace marey::cli
