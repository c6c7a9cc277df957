#pragma once

#include <string>
#include <string_view>

namespace marey::format {

/// How a text nests what it holds.
enum class Notation {
  toml,  ///< brackets, and the parts of dotted keys
  json,  ///< brackets
  xml,   ///< elements
};

/// What no file of this kind needs. Parsers and destructors call themselves once or several times a level; the stack supports this
/// many.
inline constexpr int kMaxNestingDepth = 100;

/// Whether a zero byte is among the first 4096: no text has one, and videos and images do.
bool is_binary(std::string_view text);

/// Throws Error, `name:line: ...`, where a text is nested deeper than `kMaxNestingDepth`, and if it is binary. To be asked
/// before a parser sees the text: it does not specify whether the text is right otherwise, and where it is not may count more
/// levels than there are. Time is linear, memory bounded.
void check_nesting(std::string_view text, Notation notation, const std::string& name);

}  // namespace marey::format
