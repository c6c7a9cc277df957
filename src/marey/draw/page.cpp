#include "marey/draw/page.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "marey/draw/page_style.h"
#include "marey/files/text_safety.h"

namespace marey::draw {
namespace {

constexpr std::size_t kMaxNarrow = 6, kMaxHalf = 9;  // columns that fit on a phone, and on half a screen
constexpr std::string_view kUnknown = "–", kPlusMinus = " ± ";

/// The number of "7.5" and "7.5 ± 0.2".
std::optional<double> number_of(const std::string& cell) {
  double value = 0;
  const std::size_t sign = cell.starts_with('+') ? 1 : 0;
  const auto [end, error] = std::from_chars(cell.data() + sign, cell.data() + cell.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  const std::string_view rest(end, static_cast<std::size_t>(cell.data() + cell.size() - end));
  return rest.empty() || rest.starts_with(kPlusMinus) ? std::optional(value) : std::nullopt;
}

struct PageColumn {
  std::size_t index = 0;
  bool numbers = false;
  double minimum = 0, largest = 0;
  std::string group;
};

/// Empty cells show nothing; a column without any other is omitted.
std::optional<PageColumn> column_of(const PageTable& table, std::size_t index) {
  PageColumn column{.index = index, .numbers = true, .minimum = HUGE_VAL, .largest = 0, .group = {}};
  if (index < table.groups.size()) column.group = table.groups[index];
  bool empty = true;
  for (const auto& row : table.rows) {
    if (row[index].empty()) continue;
    empty = false;
    if (row[index] == kUnknown) continue;
    const auto value = number_of(row[index]);
    column.numbers &= value.has_value();
    if (!value) continue;
    column.minimum = std::min(column.minimum, *value);
    column.largest = std::max(column.largest, *value);
  }
  return empty ? std::nullopt : std::optional(column);
}

std::string chip(const std::string& text, const std::string& colour) {
  return fmt::format("<span class=\"chip\"><i style=\"--c:{}\"></i>{}</span>", xml_escaped(colour), xml_escaped(text));
}

/// A range, "4-5.5", is not broken in two.
std::string unbroken(const std::string& head) {
  std::string result;
  for (std::size_t i = 0; i < head.size(); ++i) {
    const bool range = head[i] == '-' && i + 1 < head.size() && head[i + 1] >= '0' && head[i + 1] <= '9';
    result.append(range ? "\u2011" : std::string(1, head[i]));
  }
  return result;
}

class TableHtml {
 public:
  explicit TableHtml(const PageTable& table) : table_(table) {
    for (std::size_t i = 0; i < table.head.size(); ++i) {
      if (auto column = column_of(table, i)) columns_.push_back(std::move(*column));
    }
  }

  std::string html() {
    const std::string title = xml_escaped(table_.title);
    text_ = table_.folded ? fmt::format("<details><summary>{}: {}</summary>", title, table_.rows.size())
                          : fmt::format("<h2>{}</h2>", title);
    text_ +=
        fmt::format("<div class=\"scroll\"><table{}><thead>", columns_.size() > kMaxHalf ? " class=\"wide cards\""
                                                              : columns_.size() > kMaxNarrow || table_.cards ? " class=\"cards\""
                                                                                                             : "");
    write_groups();
    write_head();
    text_ += "</thead><tbody>\n";
    for (const auto& row : table_.rows) {
      text_ += "<tr>";
      for (const PageColumn& column : columns_) write_cell(row[column.index], column);
      text_ += "</tr>\n";
    }
    return text_ + (table_.folded ? "</tbody></table></div></details>\n" : "</tbody></table></div>\n");
  }

 private:
  /// Whether another group begins with this column: a line is drawn there.
  bool begins(std::size_t c) const { return c > 0 && columns_[c].group != columns_[c - 1].group; }

  void write_groups() {
    if (std::all_of(columns_.begin(), columns_.end(), [](const PageColumn& column) { return column.group.empty(); })) return;
    text_ += "<tr>";
    for (std::size_t first = 0, end = 0; first < columns_.size(); first = end) {
      while (end < columns_.size() && columns_[end].group == columns_[first].group) ++end;
      fmt::format_to(std::back_inserter(text_), "<th class=\"group{}\" colspan=\"{}\">{}</th>", begins(first) ? " from" : "",
                     end - first, xml_escaped(columns_[first].group));
    }
    text_ += "</tr>";
  }

  void write_head() {
    text_ += "<tr>";
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const PageColumn& column = columns_[c];
      fmt::format_to(std::back_inserter(text_), "<th class=\"{}{}\" data-label=\"{}\"><button>{}</button></th>",
                     column.numbers ? "n" : "t", begins(c) ? " from" : "", label_of(column),
                     xml_escaped(unbroken(table_.head[column.index])));
    }
    text_ += "</tr>";
  }

  /// What a column is called where its group is not above it.
  std::string label_of(const PageColumn& column) const {
    const std::string head = unbroken(table_.head[column.index]);
    return xml_escaped(column.group.empty() ? head : column.group + ": " + head);
  }

  void write_cell(const std::string& cell, const PageColumn& column) {
    auto out = std::back_inserter(text_);
    const auto at = static_cast<int>(column.index);
    const auto number =
        column.numbers && column.largest > std::max(0.0, column.minimum) && at >= table_.bars_from && at < table_.bars_end
            ? number_of(cell)
            : std::nullopt;
    const auto colour = table_.colours.find(cell);
    fmt::format_to(out, "<td class=\"{}\"", column.numbers ? "n" : table_.head[column.index] == "why" ? "why" : "t");
    if (number) fmt::format_to(out, " style=\"--w:{:.0f}%\"", 100 * std::max(0.0, *number) / column.largest);
    fmt::format_to(out, " data-label=\"{}\">", label_of(column));
    text_ += column.numbers || cell.empty() || colour == table_.colours.end() ? xml_escaped(cell) : chip(cell, colour->second);
    text_ += "</td>";
  }

  const PageTable& table_;
  std::vector<PageColumn> columns_;
  std::string text_;
};

}  // namespace

void Page::add_heading(const std::string& text) {
  body_ += "<h2>" + xml_escaped(text) + "</h2>\n";
}

void Page::add_message(const std::string& text) {
  body_ += "<p>" + xml_escaped(text) + "</p>\n";
}

void Page::add_list(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return;
  body_ += "<ul>\n";
  for (const std::string& message_text : sentences) body_ += "<li>" + xml_escaped(message_text) + "</li>\n";
  body_ += "</ul>\n";
}

void Page::add(const PageTable& table) {
  if (!table.rows.empty()) body_ += TableHtml(table).html();
}

void Page::add(const std::vector<LineChart>& charts) {
  body_ += "<div class=\"two\">\n";
  for (const LineChart& chart : charts) {
    body_ += "<figure><h3>" + xml_escaped(chart.title + ", " + chart.y_label) + "</h3>" + part_svg(chart);
    std::vector<std::pair<std::string, std::string>> legend;
    for (std::size_t i = 0; i < chart.lines.size(); ++i) legend.emplace_back(chart.lines[i].name, line_colour(i));
    add_legend(legend);
    body_ += "</figure>\n";
  }
  body_ += "</div>\n";
}

void Page::add_legend(const std::vector<std::pair<std::string, std::string>>& colours) {
  body_ += "<div class=\"legend\">";
  for (const auto& [text, colour] : colours) body_ += text.empty() ? "" : chip(text, colour);
  body_ += "</div>\n";
}

std::string Page::html() const {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<title>{0}</title><style>{1}</style></head><body><h1>{0}</h1>\n{2}<script>{3}</script></body></html>\n",
      xml_escaped(title_), kPageStyle, body_, kPageScript);
}

}  // namespace marey::draw
