#include "marey/format/csv_table.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"

namespace marey::format {
namespace {

std::string column_name(std::string_view field) {
  std::string name = unquoted(field);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

CsvTable::CsvTable(std::string_view text, const std::string& name, const std::vector<std::string>& required,
                   const std::vector<std::string>& optional) {
  std::vector<std::string> columns;
  std::vector<std::string_view> fields;
  for_each_line(text, name, [&](std::string_view line, const std::string& where) {
    if (line.starts_with('#')) return;
    split_fields(line, ',', fields);
    if (columns.empty()) {
      for (const std::string_view field : fields) columns.push_back(column_name(field));
      for (const std::string& column : required) {
        if (std::find(columns.begin(), columns.end(), column) == columns.end())
          throw Error("{}: the first row must name the columns {}{}; \"{}\" is missing", where, fmt::join(required, ","),
                      optional.empty() ? "" : fmt::format(" (and {}, if wanted)", fmt::join(optional, ",")), column);
      }
      return;
    }
    if (std::all_of(fields.begin(), fields.end(), [](std::string_view field) { return field.empty(); })) return;
    if (fields.size() > columns.size())
      throw Error("{}: has {} fields, and the first row names {} columns; a name with a comma stands in double quotes", where,
                  fields.size(), columns.size());
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < fields.size(); ++i) row[columns[i]] = unquoted(fields[i]);
    rows_.emplace_back(std::move(row), where);
  });
  if (columns.empty()) throw Error("{}: is empty; its first row must name the columns {}", name, fmt::join(required, ","));
}

}  // namespace marey::format
