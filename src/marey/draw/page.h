// A page that a browser shows, prints and sorts without anything else: no network, no other file.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "marey/draw/chart.h"

namespace marey::draw {

/// A table that its reader sorts by any column. A column of numbers alone gets bars, as long as its number's share of the largest,
/// unless all are equal;
/// "7 ± 2" and "–" are numbers too. Columns that are empty in every row are omitted.
struct PageTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as `head` has
  int bars_from = 0, bars_end = 1000;          ///< columns outside these have no bars: they are names, or places
  std::vector<std::string> groups = {};        ///< of each column what stands above its head and its neighbours'; may be shorter
  bool folded = false;                         ///< its title alone is shown until its reader opens it: many rows
  bool cards = false;                          ///< a card a row on a phone, though its columns are few: their cells are long
  std::map<std::string, std::string> colours = {};  ///< CSS colours of texts that are shown with one, such as teams
};

/// Light or dark as the reader's system is, with everything open and nothing dark but pitches on paper. It is as wide as a screen,
/// a phone or a sheet of A4 is: on a phone a table of many columns is a card a row.
class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void add_heading(const std::string& text);
  void add_message(const std::string& text);
  void add_list(const std::vector<std::string>& sentences);
  /// Nothing for a table without rows.
  void add(const PageTable& table);
  /// Charts that stand side by side where there is room.
  void add(const std::vector<LineChart>& charts);
  /// What colours mean: texts and their CSS colours.
  void add_legend(const std::vector<std::pair<std::string, std::string>>& colours);
  /// HTML as it is: its texts are escaped already.
  void add_html(std::string_view html) { body_ += html; }

  std::string html() const;

 private:
  std::string title_, body_;
};

}  // namespace marey::draw
