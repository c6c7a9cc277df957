// Calibrations come from untrusted clients, and OpenCV's own parser (4.6) is not made for that: some 250 bytes of YAML hold it for
// ever, and XML that is cut off within a tag is read beyond its end. So YAML is read here, strictly and in one pass, each step of
// which takes at least one byte; JSON is YAML's bracketed half; XML is pugixml's.
#include "marey/format/rig/file_storage.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/nesting.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::rig {
namespace {

using Json = nlohmann::json;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (is_blank(text.front()) || text.front() == '\n')) text.remove_prefix(1);
  while (!text.empty() && (is_blank(text.back()) || text.back() == '\n')) text.remove_suffix(1);
  return text;
}

/// A text without quotes: a number, nothing, or itself.
Json scalar(std::string_view text) {
  if (text.empty() || text == "~") return nullptr;
  std::string_view digits = text;
  if (digits.front() == '+') digits.remove_prefix(1);
  if (digits == ".Nan" || digits == ".NaN" || digits == ".nan") return std::numeric_limits<double>::quiet_NaN();
  if (digits == ".Inf" || digits == ".inf") return std::numeric_limits<double>::infinity();
  if (digits == "-.Inf" || digits == "-.inf") return -std::numeric_limits<double>::infinity();
  const bool numeric = digits.find_first_of("0123456789") != std::string_view::npos;
  double value = 0;
  const auto [stop, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (numeric && failed == std::errc() && stop == digits.data() + digits.size()) return value;
  return text;
}

class YamlReader {
 public:
  YamlReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Json document();

 private:
  /// Counts how deep values stand in each other.
  class Level {
   public:
    explicit Level(YamlReader& reader) : reader_(reader) {
      if (++reader_.depth_ > kMaxNestingDepth)
        reader_.refuse(fmt::format("is nested more than {} deep, as no file of its kind is; it must be damaged", kMaxNestingDepth));
    }
    ~Level() { --reader_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    YamlReader& reader_;
  };

  [[noreturn]] void refuse(const std::string& what) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    throw Error("{}:{}: {}", name_, std::count(text_.begin(), end, '\n') + 1, what);
  }

  bool more() const { return at_ < text_.size(); }
  char here() const { return text_[at_]; }
  bool begins(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  /// Of a word that stands alone: what follows is a blank, the line's end or the text's.
  bool ends_word(std::size_t at) const { return at >= text_.size() || is_blank(text_[at]) || text_[at] == '\n'; }
  bool is_dash() const { return more() && here() == '-' && ends_word(at_ + 1); }
  std::size_t column() const { return at_ - line_; }
  bool at_document_end() const { return column() == 0 && (begins("...") || begins("---")) && ends_word(at_ + 3); }

  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  /// Within the line, and over a comment to its end.
  void skip_blanks();
  /// Over lines.
  void skip_space();
  void skip_tag();
  bool line_ends() {
    skip_blanks();
    return !more() || here() == '\n';
  }

  Json value();
  /// What stands behind a key, or behind nothing, on its line.
  Json value_in_line();
  Json value_of_key(std::size_t map_column);
  Json map(std::size_t column);
  Json sequence(std::size_t column);
  Json brackets();
  Json value_in_brackets();
  std::string key_in_brackets();
  std::string quoted();
  void escaped(std::string& to);
  std::string_view plain(std::string_view ends);
  /// Where the key that begins here ends, which is before its colon; nothing if the line is not a key.
  std::optional<std::size_t> end_of_key() const;
  void add(Json& map, const std::string& key, Json value);

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0, line_ = 0;  // line_: where the line begins
  int depth_ = 0;
};

void YamlReader::skip_blanks() {
  while (more() && is_blank(here())) ++at_;
  if (more() && here() == '#' && (at_ == line_ || is_blank(text_[at_ - 1]))) skip_line();
}

void YamlReader::skip_space() {
  for (skip_blanks(); more() && here() == '\n'; skip_blanks()) line_ = ++at_;
}

void YamlReader::skip_tag() {
  if (!more() || here() != '!') return;
  while (!ends_word(at_)) ++at_;
  skip_blanks();
}

Json YamlReader::document() {
  for (skip_space(); more() && here() == '%'; skip_space()) skip_line();
  if (begins("---") && ends_word(at_ + 3)) at_ += 3;
  skip_space();
  if (!more() || at_document_end()) refuse("holds nothing");
  Json result = value();
  skip_space();
  if (more() && column() == 0 && begins("...")) {
    at_ += 3;
    skip_space();
  }
  if (more()) refuse("another value follows where the file's value has ended");
  return result;
}

Json YamlReader::value() {
  const Level level(*this);
  skip_tag();
  skip_space();
  if (!more()) return nullptr;
  if (is_dash()) return sequence(column());
  if (here() != '[' && here() != '{' && end_of_key()) return map(column());
  return value_in_line();
}

Json YamlReader::value_in_line() {
  skip_tag();
  if (line_ends()) return nullptr;
  Json result;
  if (here() == '[' || here() == '{') {
    result = brackets();
  } else if (here() == '"' || here() == '\'') {
    result = quoted();
  } else {
    if (here() == '&' || here() == '*' || here() == '|' || here() == '>' || here() == '%' || here() == '@' || here() == '`')
      refuse(fmt::format("\"{}\" begins nothing that a calibration holds", here()));
    result = scalar(plain(""));
  }
  if (!line_ends()) refuse("something follows where a value has ended");
  return result;
}

std::optional<std::size_t> YamlReader::end_of_key() const {
  std::size_t at = at_;
  if (here() == '"' || here() == '\'') {
    for (++at; at < text_.size() && text_[at] != here() && text_[at] != '\n'; ++at)
      at += text_[at] == '\\' && here() == '"' ? 1 : 0;
    if (at++ >= text_.size()) return std::nullopt;
    const std::size_t end = at;
    while (at < text_.size() && is_blank(text_[at])) ++at;
    return at < text_.size() && text_[at] == ':' ? std::optional(end) : std::nullopt;
  }
  for (; at < text_.size() && text_[at] != '\n'; ++at) {
    if (text_[at] == '#' && (at == line_ || is_blank(text_[at - 1]))) return std::nullopt;
    if (text_[at] == ':' && ends_word(at + 1)) return at;
  }
  return std::nullopt;
}

void YamlReader::add(Json& map, const std::string& key, Json value) {
  if (!map.emplace(key, std::move(value)).second) refuse(fmt::format("{} is there twice", shown(key)));
}

Json YamlReader::map(std::size_t column) {
  Json result = Json::object();
  do {
    const auto end = end_of_key();
    if (!end) refuse("a name with a colon and a value must stand here");
    std::string key;
    if (here() == '"' || here() == '\'') {
      key = quoted();
    } else {
      key = trimmed(text_.substr(at_, *end - at_));
    }
    at_ = text_.find(':', *end) + 1;
    add(result, key, value_of_key(column));
    skip_space();
    if (more() && this->column() > column) refuse("stands further in than what it belongs to");
  } while (more() && this->column() == column && !at_document_end());
  return result;
}

Json YamlReader::value_of_key(std::size_t map_column) {
  skip_blanks();
  skip_tag();
  if (!line_ends()) {
    const Level level(*this);
    return value_in_line();
  }
  skip_space();
  if (!more() || at_document_end()) return nullptr;
  if (column() > map_column || (column() == map_column && is_dash())) return value();
  return nullptr;
}

Json YamlReader::sequence(std::size_t column) {
  Json result = Json::array();
  do {
    ++at_;
    if (line_ends()) {
      skip_space();
      result.push_back(more() && this->column() > column ? value() : Json());
    } else {
      result.push_back(value());
    }
    skip_space();
    if (more() && this->column() > column) refuse("stands further in than what it belongs to");
  } while (this->column() == column && is_dash());
  return result;
}

Json YamlReader::brackets() {
  const Level level(*this);
  const bool is_map = here() == '{';
  const char close = is_map ? '}' : ']';
  Json result = is_map ? Json::object() : Json::array();
  ++at_;
  for (skip_space(); more() && here() != close; skip_space()) {
    if (is_map) {
      std::string key = key_in_brackets();
      add(result, key, value_in_brackets());
    } else {
      result.push_back(value_in_brackets());
    }
    skip_space();
    if (more() && here() == close) break;
    if (!more() || here() != ',') refuse(fmt::format("\",\" or \"{}\" must stand here", close));
    ++at_;
  }
  if (!more()) refuse(fmt::format("\"{}\" is missing; the file is cut off", close));
  ++at_;
  return result;
}

std::string YamlReader::key_in_brackets() {
  std::string key = here() == '"' || here() == '\'' ? quoted() : std::string(trimmed(plain(",:[]{}")));
  skip_space();
  if (!more() || here() != ':') refuse("a name with a colon and a value must stand here");
  ++at_;
  return key;
}

Json YamlReader::value_in_brackets() {
  skip_space();
  skip_tag();
  if (!more()) return nullptr;
  if (here() == '[' || here() == '{') return brackets();
  if (here() == '"' || here() == '\'') return quoted();
  return scalar(plain(",[]{}"));
}

/// To the end of the line, a comment, or one of `ends`.
std::string_view YamlReader::plain(std::string_view ends) {
  const std::size_t begin = at_;
  while (more() && here() != '\n' && ends.find(here()) == std::string_view::npos &&
         !(here() == '#' && at_ > begin && is_blank(text_[at_ - 1])))
    ++at_;
  return trimmed(text_.substr(begin, at_ - begin));
}

std::string YamlReader::quoted() {
  const char quote = here();
  std::string result;
  for (++at_; more() && here() != '\n'; ++at_) {
    if (here() == '\\' && quote == '"') {
      escaped(result);
    } else if (here() != quote) {
      result += here();
    } else if (quote == '\'' && at_ + 1 < text_.size() && text_[at_ + 1] == '\'') {
      result += text_[++at_];
    } else {
      ++at_;
      return result;
    }
  }
  refuse("a quoted text does not end on its line");
}

/// Leaves `at_` on the last character of the escape.
void YamlReader::escaped(std::string& to) {
  constexpr std::string_view kNames = "nrt0\"'\\/ ", kMeanings("\n\r\t\0\"'\\/ ", 9);
  const char name = ++at_ < text_.size() ? here() : '\n';
  if (const std::size_t known = kNames.find(name); known != std::string_view::npos) {
    to += kMeanings[known];
    return;
  }
  const std::size_t digits = name == 'x' ? 2 : name == 'u' ? 4 : 0;
  unsigned code = 0;
  const std::string_view hex = text_.substr(std::min(at_ + 1, text_.size()), digits);
  const auto [stop, failed] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (digits == 0 || hex.size() != digits || failed != std::errc() || stop != hex.data() + hex.size() || surrogate)
    refuse("an escape in a quoted text is not one that is known");
  at_ += digits;
  if (digits == 2 || code < 0x80) {
    to += static_cast<char>(code);
  } else if (code < 0x800) {
    to += {static_cast<char>(0xC0 | (code >> 6)), static_cast<char>(0x80 | (code & 0x3F))};
  } else {
    to += {static_cast<char>(0xE0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 0x3F)),
           static_cast<char>(0x80 | (code & 0x3F))};
  }
}

// ---- XML

/// Adds each word, and each text in quotes.
void add_words(Json& to, std::string_view text) {
  for (std::string_view rest = trimmed(text); !rest.empty(); rest = trimmed(rest)) {
    const std::size_t quote = rest.front() == '"' ? rest.find('"', 1) : std::string_view::npos;
    const std::size_t end = std::min(quote == std::string_view::npos ? rest.find_first_of(" \t\r\n") : quote + 1, rest.size());
    to.push_back(quote == std::string_view::npos ? scalar(rest.substr(0, end)) : Json(rest.substr(1, end - 2)));
    rest.remove_prefix(end);
  }
}

/// Of an element without elements: the text in quotes, a number, numbers, or the text.
Json xml_text(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return text.substr(1, text.size() - 2);
  Json words = Json::array();
  add_words(words, text);
  if (words.empty()) return nullptr;
  if (words.size() == 1) return words.front();
  const bool numeric = std::all_of(words.begin(), words.end(), [](const Json& word) { return word.is_number(); });
  return numeric ? words : Json(text);
}

/// Elements called "_", and words between them, are a sequence. Depth is bounded by who calls.
Json xml_value(const pugi::xml_node& element, const std::string& name) {
  const auto is_element = [](const pugi::xml_node& node) { return node.type() == pugi::node_element; };
  if (!element.find_child(is_element)) return xml_text(element.child_value());
  const bool is_sequence = !element.child("_").empty();
  Json result = is_sequence ? Json::array() : Json::object();
  for (const pugi::xml_node& child : element.children()) {
    const std::string key = child.name();
    if (is_element(child) ? (key == "_") != is_sequence : !is_sequence)
      throw Error("{}: <{}> holds what is named beside what is not", name, element.name());
    if (!is_element(child)) {
      add_words(result, child.value());
    } else if (is_sequence) {
      result.push_back(xml_value(child, name));
    } else if (!result.emplace(key, xml_value(child, name)).second) {
      throw Error("{}: <{}> is there twice", name, key);
    }
  }
  return result;
}

}  // namespace

nlohmann::json parse_file_storage(std::string_view text, const std::string& name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string_view content = trimmed(text);
  if (!content.starts_with('<')) return YamlReader(text, name).document();
  const pugi::xml_document document = parse_xml(content, name);
  const pugi::xml_node root = document.child("opencv_storage");
  if (!root) throw Error("{}: there is no <opencv_storage> in it", name);
  return xml_value(root, name);
}

}  // namespace marey::format::rig
