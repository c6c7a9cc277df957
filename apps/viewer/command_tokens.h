#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace marey::viewer {

/// What a page says is a line of words with blanks between. Takes the first one off; empty at the end.
inline std::string_view next_word(std::string_view& line) {
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(word.size());
  return word;
}

/// A whole number in [low, high], and nothing else.
inline std::optional<std::int64_t> whole_in(std::string_view word, std::int64_t low, std::int64_t high) {
  std::int64_t value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size() || value < low || value > high) return std::nullopt;
  return value;
}

}  // namespace marey::viewer
