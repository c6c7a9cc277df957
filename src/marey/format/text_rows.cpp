#include "marey/format/text_rows.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace marey::format {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Where the field that begins the line ends.
std::size_t field_length(std::string_view line, char separator) {
  std::size_t at = 0;
  if (line.starts_with('"')) {
    at = 1;
    while (at < line.size() && !(line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"'))) {
      at += line[at] == '"' ? 2 : 1;
    }
  }
  const std::size_t end = at < line.size() ? line.find(separator, at) : std::string_view::npos;
  return end == std::string_view::npos ? line.size() : end;
}

}  // namespace

TextLines::TextLines(std::string_view text) : text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

bool TextLines::next(std::string_view& line) {
  if (text_.empty()) return false;
  const std::size_t end = text_.find('\n');
  ended_ = end != std::string_view::npos;
  line = text_.substr(0, end);
  text_.remove_prefix(ended_ ? end + 1 : text_.size());
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++number_;
  return true;
}

void TextLines::go_to(std::string_view rest, std::size_t number) {
  text_ = rest;
  number_ = number - 1;
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t end = field_length(line, separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
  }
}

std::string unquoted(std::string_view field) {
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') return std::string(field);
  std::string text;
  field = field.substr(1, field.size() - 2);
  for (std::size_t i = 0; i < field.size(); ++i) {
    text += field[i];
    if (field[i] == '"' && i + 1 < field.size() && field[i + 1] == '"') ++i;
  }
  return text;
}

std::string quoted_field(const std::string& text) {
  const bool plain = text.find_first_of(",;\"\t\r\n") == std::string::npos && trimmed(text).size() == text.size();
  if (plain) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + '"';
}

std::optional<double> number_of(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || stop != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> whole_number_of(std::string_view field) {
  const auto value = number_of(field);
  if (!value || *value != std::floor(*value) || std::abs(*value) > 9e15) return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

std::string shown(std::string_view text) {
  std::string result = "\"";
  for (const char c : text.substr(0, 24)) result += c < ' ' || c > '~' ? '?' : c;
  return result + (text.size() > 24 ? "...\"" : "\"");
}

}  // namespace marey::format
