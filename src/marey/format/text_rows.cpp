#include "marey/format/text_rows.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "marey/core/stop.h"
#include "marey/files/text_safety.h"

namespace marey::format {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

constexpr std::size_t kLinesBetweenStops = 1024;

/// What a spreadsheet would compute instead of showing it, behind any apostrophes.
bool is_formula(std::string_view text) {
  const std::size_t begin = text.find_first_not_of('\'');
  return begin != std::string_view::npos && std::string_view("=+-@").find(text[begin]) != std::string_view::npos &&
         !number_of(text);
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
  if (number_ % kLinesBetweenStops == 0) stop_point();
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
  std::string text;
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') {
    text = field;
  } else {
    field = field.substr(1, field.size() - 2);
    for (std::size_t i = 0; i < field.size(); ++i) {
      text += field[i];
      if (field[i] == '"' && i + 1 < field.size() && field[i + 1] == '"') ++i;
    }
  }
  if (text.starts_with('\'') && is_formula(text)) text.erase(0, 1);
  return text;
}

std::string quoted_field(const std::string& text) {
  std::string kept = plain_text(text);
  if (is_formula(kept)) kept.insert(0, 1, '\'');
  const bool plain = kept.find_first_of(",;\"") == std::string::npos && trimmed(kept).size() == kept.size();
  if (plain) return kept;
  std::string result = "\"";
  for (const char c : kept) {
    if (c == '"') result += '"';
    result += c;
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
