// A small CSV file with a row of names on top, whose columns may come in any order.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace marey::format {

class CsvTable {
 public:
  class Row {
   public:
    Row(std::map<std::string, std::string> fields, std::string where) : fields_(std::move(fields)), where_(std::move(where)) {}
    /// Without blanks and quotes; empty if the file has no such column.
    std::string text(const std::string& column) const {
      const auto found = fields_.find(column);
      return found == fields_.end() ? std::string() : found->second;
    }
    const std::string& where() const { return where_; }  ///< "names.csv:3"

   private:
    std::map<std::string, std::string> fields_;
    std::string where_;
  };

  /// Throws Error if a column that is required is missing, or a row has more fields than the first. Columns of other names are
  /// skipped. Lines that are empty, or begin with #, are not rows.
  CsvTable(std::string_view text, const std::string& name, const std::vector<std::string>& required,
           const std::vector<std::string>& optional);

  const std::vector<Row>& rows() const { return rows_; }

 private:
  std::vector<Row> rows_;
};

}  // namespace marey::format
