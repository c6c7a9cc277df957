#include "marey/draw/page.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "marey/core/text_safety.h"

namespace marey::draw {
namespace {

const char* const kPageStyle = R"(
:root { color-scheme: light dark; --ground: #fff; --text: #1d232a; --faint: #687076; --line: #dde1e4; --bar: #cfe3d4; --head: #f3f5f6; --mark: #d9480f }
@media (prefers-color-scheme: dark) {
  :root { --ground: #14181c; --text: #e6e9eb; --faint: #9aa3aa; --line: #30373d; --bar: #2c4a37; --head: #1d2328; --mark: #ff922b }
}
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 76em; padding: 0 1em; color: var(--text); background: var(--ground) }
h1 { font-size: 1.6em } h2 { margin-top: 1.8em; font-size: 1.2em }
.scroll { overflow-x: auto } table { border-collapse: collapse; font-variant-numeric: tabular-nums }
th, td { padding: .3em .7em; border-bottom: 1px solid var(--line); text-align: left; white-space: nowrap }
td.n, th.n { text-align: right } td.why { white-space: normal }
td.n { background: linear-gradient(90deg, var(--bar) var(--w, 0), transparent var(--w, 0)) }
th { background: var(--head); position: sticky; top: 0; padding: 0 }
th button { all: unset; cursor: pointer; padding: .3em .7em; display: block } th button:focus-visible { outline: 2px solid var(--mark) }
th[aria-sort=ascending] button::after { content: " ▲" } th[aria-sort=descending] button::after { content: " ▼" }
svg { width: 100%; height: auto } details { margin: .5em 0; border-bottom: 1px solid var(--line) } summary { cursor: pointer; font-weight: 600; padding: .3em 0 }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(22em, 1fr)); gap: 1.2em } figure { margin: 0 } figcaption { color: var(--faint); font-size: .9em }
.axis { fill: var(--faint) } .grid { stroke: var(--line) } .speed { stroke: var(--text) } .sprint { fill: var(--mark); fill-opacity: .25 }
@media print {
  :root { --ground: #fff; --text: #000; --faint: #444; --line: #bbb; --bar: #ddd; --head: #eee }
  body { max-width: none; margin: 0; font-size: 10px; print-color-adjust: exact; -webkit-print-color-adjust: exact }
  details, figure, tr { break-inside: avoid } th { position: static }
}
)";

// Sorts by the column whose head is pressed, numbers by size; opens everything before it is printed.
const char* const kPageScript = R"(
for (const head of document.querySelectorAll("th")) head.firstChild.onclick = () => {
  const table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex, numbers = head.classList.contains("n");
  const down = head.getAttribute("aria-sort") === (numbers ? "descending" : "ascending") ? !numbers : numbers;
  const value = row => row.cells[column].textContent;
  const number = text => text === "" ? -Infinity : parseFloat(text);
  const rows = [...body.rows].sort((a, b) => numbers ? number(value(a)) - number(value(b)) : value(a).localeCompare(value(b), undefined, {numeric: true}));
  for (const other of table.querySelectorAll("th")) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  body.append(...(down ? rows.reverse() : rows));
};
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach(each => each.open = true));
)";

std::optional<double> number_of(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct Column {
  bool numbers = false;
  double largest = 0;
};

/// Empty cells say nothing; a column without any other is none of numbers.
Column column_of(const PageTable& table, std::size_t index) {
  Column column;
  for (const auto& row : table.rows) {
    if (row[index].empty()) continue;
    const auto value = number_of(row[index]);
    if (!value) return {};
    column.numbers = true;
    column.largest = std::max(column.largest, *value);
  }
  return column;
}

}  // namespace

void Page::add_heading(const std::string& text) {
  body_ += "<h2>" + xml_escaped(text) + "</h2>\n";
}

void Page::add_sentence(const std::string& text) {
  body_ += "<p>" + xml_escaped(text) + "</p>\n";
}

void Page::add(const PageTable& table) {
  auto out = std::back_inserter(body_);
  std::vector<Column> columns;
  fmt::format_to(out, "<h2>{}</h2><div class=\"scroll\"><table><thead><tr>", xml_escaped(table.title));
  for (std::size_t i = 0; i < table.head.size(); ++i) {
    columns.push_back(column_of(table, i));
    fmt::format_to(out, "<th{}><button>{}</button></th>", columns.back().numbers ? " class=\"n\"" : "", xml_escaped(table.head[i]));
  }
  body_ += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool bar = columns[i].numbers && columns[i].largest > 0 && static_cast<int>(i) >= table.bars_from &&
                       static_cast<int>(i) < table.bars_end && !row[i].empty();
      if (bar) {
        const double share = std::max(0.0, *number_of(row[i])) / columns[i].largest;
        fmt::format_to(out, "<td class=\"n\" style=\"--w:{:.0f}%\">{}</td>", 100 * share, row[i]);
      } else {
        fmt::format_to(out, "<td{}>{}</td>",
                       columns[i].numbers       ? " class=\"n\""
                       : table.head[i] == "why" ? " class=\"why\""
                                                : "",
                       xml_escaped(row[i]));
      }
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

std::string Page::html() const {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<title>{0}</title><style>{1}</style></head><body><h1>{0}</h1>\n{2}<script>{3}</script></body></html>\n",
      xml_escaped(title_), kPageStyle, body_, kPageScript);
}

}  // namespace marey::draw
