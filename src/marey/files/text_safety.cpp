#include "marey/files/text_safety.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace marey {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool sound = false;
};

/// The character that begins the text, which is not empty (RFC 3629: no overlong forms, no surrogates).
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t bytes = lead >= 0xF0 && lead < 0xF5 ? 4 : lead >= 0xE0 && lead < 0xF0 ? 3 : lead >= 0xC2 && lead < 0xE0 ? 2 : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::array<std::uint32_t, 5> kMinValue{0, 0, 0x80, 0x800, 0x10000};
  const bool sound = code >= kMinValue[bytes] && code <= 0x10FFFF && !(code >= 0xD800 && code < 0xE000);
  return sound ? Character{code, bytes, true} : Character{};
}

bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0xFFFE || code == 0xFFFF;
}

}  // namespace

std::string plain_text(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character next = first_of(text);
    if (next.code == '\t' || next.code == '\n' || next.code == '\r' || next.code == 0x85) {
      result += ' ';
    } else {
      result += next.sound && !is_control(next.code) ? text.substr(0, next.bytes) : kReplacement;
    }
    text.remove_prefix(next.bytes);
  }
  return result;
}

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char letter : plain_text(text)) {
    switch (letter) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

}  // namespace marey
