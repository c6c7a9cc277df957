#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace marey::test {

/// How often `part` stands in `text`; what overlaps counts.
inline std::size_t count_of(std::string_view part, std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The text, this often in a row.
inline std::string repeated(std::string_view text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) result += text;
  return result;
}

}  // namespace marey::test
