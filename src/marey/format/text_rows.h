#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::format {

/// The lines of a text, with either line ending; a byte order mark is skipped. Nothing is copied.
class TextLines {
 public:
  explicit TextLines(std::string_view text);
  /// False at the end.
  bool next(std::string_view& line);
  /// Of the line given last; counts from 1.
  std::size_t number() const { return number_; }
  /// Whether the line given last ended with a line feed, as whole files' lines do.
  bool ended() const { return ended_; }
  std::string_view rest() const { return text_; }
  /// Continues at `rest`, a later part of the same text, whose first line has this number.
  void go_to(std::string_view rest, std::size_t number);

 private:
  std::string_view text_;
  std::size_t number_ = 0;
  bool ended_ = true;
};

/// Calls `take(line, where)` for each line that is not empty; `where` is its place for messages, "match.dat:12".
template <typename Take>
void for_each_line(std::string_view text, const std::string& name, Take&& take) {
  TextLines lines(text);
  std::string_view line;
  while (lines.next(line)) {
    if (!line.empty()) take(line, name + ':' + std::to_string(lines.number()));
  }
}

/// The line's fields, cut at `separator` but not within quotes; blanks round a field are taken off, its quotes are kept.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);
/// A field without its quotes (RFC 4180), and without the apostrophe that `quoted_field` sets.
std::string unquoted(std::string_view field);
/// A text as a field: plain text (files/text_safety.h), in quotes where it must be. A text that a spreadsheet would compute, for it
/// begins with = + - or @ and is no number, gets an apostrophe before it, as spreadsheets themselves mark text.
std::string quoted_field(const std::string& text);

/// A finite number; nothing for what is not one.
std::optional<double> number_of(std::string_view field);
std::optional<std::int64_t> whole_number_of(std::string_view field);

/// A piece of a file that is fit for a one-line message, in quotes.
std::string shown(std::string_view text);

}  // namespace marey::format
