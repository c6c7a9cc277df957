#include "page_command.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "marey/files/text_safety.h"

#include "command_tokens.h"

namespace marey::viewer {
namespace {

/// A number in [low, high] in digits, and nothing else.
std::optional<double> number_in(std::string_view word, double low, double high) {
  double value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size() || !(value >= low && value <= high)) return std::nullopt;
  return value;
}

std::optional<CameraId> camera_in(std::string_view& line) {
  const auto number = whole_in(next_word(line), 0, kMaxCameras - 1);
  return number ? std::optional(CameraId{static_cast<int>(*number)}) : std::nullopt;
}

bool is_over(std::string_view line) {
  return next_word(line).empty();
}

std::optional<PageCommand> camera_control(std::string_view line) {
  const auto camera = camera_in(line);
  const std::string_view name = next_word(line);
  const auto value = number_in(next_word(line), 0, 1e6);
  if (!camera || !value || (name != "exposure" && name != "gain") || !is_over(line)) return std::nullopt;
  return SetCameraControl{*camera, std::string(name), *value};
}

std::optional<PageCommand> threshold(std::string_view line) {
  const auto camera = camera_in(line);
  const std::string_view word = next_word(line);
  const auto level = number_in(word, -1e9, 1e9);
  if (!camera || (!level && word != "auto") || !is_over(line)) return std::nullopt;
  return SetThreshold{*camera, level};
}

std::optional<PageCommand> masks(ChangeMasks::What what, std::string_view line) {
  const auto camera = camera_in(line);
  if (!camera) return std::nullopt;
  if (what == ChangeMasks::What::learn_lit)
    return is_over(line) ? std::optional<PageCommand>(ChangeMasks{what, *camera, {}}) : std::nullopt;
  std::string_view rest = line;
  if (what == ChangeMasks::What::remove && next_word(rest) == "all" && is_over(rest))
    return ChangeMasks{ChangeMasks::What::remove_all, *camera, {}};
  std::vector<int> numbers;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
    const auto number = whole_in(word, 0, Mask::kMaxDistance);
    if (!number || numbers.size() >= 2 * Mask::kMaxCorners) return std::nullopt;
    numbers.push_back(static_cast<int>(*number));
  }
  const auto part = Mask::of_numbers(numbers);
  return part ? std::optional<PageCommand>(ChangeMasks{what, *camera, part}) : std::nullopt;
}

std::optional<PageCommand> name(std::string_view line) {
  const auto track = whole_in(next_word(line), 0, std::numeric_limits<int>::max());
  if (!track) return std::nullopt;
  std::string label = plain_text(line.substr(std::min(line.find_first_not_of(' '), line.size())));
  label.erase(label.find_last_not_of(' ') + 1);
  if (label.size() > kMaxName) return std::nullopt;
  return NameTrack{TrackId{static_cast<int>(*track)}, std::move(label)};
}

}  // namespace

std::optional<PageCommand> page_command(std::string_view line) {
  const std::string_view word = next_word(line);
  if (word == "dial") return camera_control(line);
  if (word == "threshold") return threshold(line);
  if (word == "mask") return masks(ChangeMasks::What::add, line);
  if (word == "unmask") return masks(ChangeMasks::What::remove, line);
  if (word == "lit") return masks(ChangeMasks::What::learn_lit, line);
  if (word == "name") return name(line);
  if (word == "save" && is_over(line)) return SaveRig{};
  return std::nullopt;
}

}  // namespace marey::viewer
