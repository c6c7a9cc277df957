#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "marey/format/mapped_file.h"
#include "marey/format/motion/motion.h"
#include "marey/format/text_rows.h"

namespace marey::format::motion {

/// How a text lies that has a row for each frame and three columns for each marker: TRC and its relatives.
struct WideTable {
  char separator = ',';
  std::size_t frame_column = 0;
  std::optional<std::size_t> time_column;
  std::vector<std::size_t> x_columns;  ///< of each of the info's tracks; y and z stand beside it
  double unit_m = 0.001;
  std::int64_t first_frame_number = 1;  ///< what the file calls frame 0
  std::string_view rows;                ///< the text behind the headings
  std::size_t first_line = 1;           ///< its number within the file
};

/// Reads the rows one by one. Blank cells (also NaN) are missing points; a blank line ends nothing.
class WideTableReader : public MotionReader {
 public:
  /// `name` stands for the path in messages. `file` keeps the text where it lies in one.
  WideTableReader(std::unique_ptr<MappedFile> file, std::string name, WideTable table, MotionInfo info,
                  std::vector<std::string> warnings);

  const MotionInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::optional<Instant> next() override;

 private:
  Instant frame_of(const std::vector<std::string_view>& fields);
  std::optional<Sample> point_at(const std::vector<std::string_view>& fields, std::size_t track) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::unique_ptr<MappedFile> file_;
  std::string name_;
  WideTable table_;
  MotionInfo info_;
  std::vector<std::string> warnings_;
  TextLines lines_;
  std::vector<std::string_view> fields_;
  std::optional<std::int64_t> last_index_;
  std::int64_t read_ = 0;
};

}  // namespace marey::format::motion
