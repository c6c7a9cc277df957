// A page that a browser shows, prints and sorts without anything else: no network, no other file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace marey::draw {

/// A table that its reader sorts by any column. A column of numbers alone gets bars, as long as its number's share of the largest.
struct PageTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as `head` has
  int bars_from = 0, bars_end = 1000;          ///< columns outside these have no bars: they are names, or places
};

/// Light or dark as the reader's system is, with everything open and nothing dark on paper.
class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void add_heading(const std::string& text);
  void add_sentence(const std::string& text);
  void add(const PageTable& table);
  /// HTML as it is: its texts are escaped already.
  void add_html(std::string_view html) { body_ += html; }

  std::string html() const;

 private:
  std::string title_, body_;
};

}  // namespace marey::draw
