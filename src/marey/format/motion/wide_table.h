// Texts that have a row for each frame and three columns for each marker: TRC, Motive's and Nexus's CSV, and their relatives. What
// they share is here: how headings are gathered, how rows are read, how they are written.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/files/whole_file.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/point_sink.h"
#include "marey/format/text_rows.h"

namespace marey::format::motion {

/// Where a body's pose lies in a row: three columns of its place, and its rotation.
struct WideBody {
  enum class Rotation {
    quaternion_xyzw,    ///< four columns
    matrix_by_columns,  ///< nine: the first column of the matrix, the second, the third
  };
  BodyId body{};
  std::size_t position_column = 0, rotation_column = 0;
  Rotation rotation = Rotation::quaternion_xyzw;
};

/// How such a text lies.
struct WideTable {
  char separator = ',';
  std::optional<std::size_t> frame_column = 0;  ///< nothing: rows follow each other
  bool zeros_are_missing = false;               ///< a point at exactly (0, 0, 0)
  std::vector<WideBody> bodies;
  std::optional<std::size_t> time_column;
  std::vector<std::size_t> x_columns;  ///< of each of the info's tracks; y and z stand beside it
  double unit_m = 0.001;
  std::int64_t first_frame_number = 1;  ///< what the file calls frame 0
  std::string_view rows;                ///< the text behind the headings
  std::size_t first_line = 1;           ///< its number within the file
};

/// What stands above the rows, as a format reads it line by line.
class WideTableHead {
 public:
  /// `name` stands for the path in messages.
  WideTableHead(std::string_view text, std::string name) : name_(std::move(name)), lines_(text) {}

 protected:
  /// The next line, cut at the table's separator; false at the end.
  bool next_line();
  /// Throws Error if the text ends before it.
  const std::vector<std::string_view>& line(const char* which);
  /// Throws Error, which says `otherwise`, where it is not a rate.
  void set_rate(std::optional<double> rate_hz, const std::string& otherwise);
  void add_marker(std::string label, std::size_t x_column);
  void add_body(std::string label, WideBody body);
  void warn(const std::string& message_text) { warnings_.push_back(name_ + ": " + message_text); }
  [[noreturn]] void fail(const std::string& what) const;

  /// Reads on where the headings ended. `file` keeps the text where it lies in one.
  std::unique_ptr<FileReader> rows_of(std::unique_ptr<MappedFile> file);

  std::string name_;
  TextLines lines_;
  std::vector<std::string_view> fields_;
  WideTable table_;
  FileInfo info_;

 private:
  std::vector<std::string> warnings_;
};

/// Reads the rows one by one. Blank cells (also NaN) are missing points; a blank line ends nothing.
class WideTableReader : public FileReader {
 public:
  WideTableReader(std::unique_ptr<MappedFile> file, std::string name, WideTable table, FileInfo info,
                  std::vector<std::string> warnings);

  const FileInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::optional<Instant> next() override;

 private:
  Instant frame_of(const std::vector<std::string_view>& fields);
  std::optional<Sample> point_at(const std::vector<std::string_view>& fields, std::size_t track) const;
  /// Nothing if a cell of it is blank, or the rotation is not one.
  std::optional<BodyPose> pose_at(const std::vector<std::string_view>& fields, const WideBody& body) const;
  std::optional<double> number_at(const std::vector<std::string_view>& fields, std::size_t column) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::unique_ptr<MappedFile> file_;
  std::string name_;
  WideTable table_;
  FileInfo info_;
  std::vector<std::string> warnings_;
  TextLines lines_;
  std::vector<std::string_view> fields_;
  std::optional<std::int64_t> last_index_;
  std::int64_t read_ = 0;
};

/// Writes such a text: a row for each frame from the plan's first to its last, those without points too.
class WideTableWriter : public PointSink {
 public:
  WideTableWriter(const std::string& path, const WritePlan& plan);

  void write(const Instant& frame) final;
  void finish() final;

 protected:
  std::int64_t frames() const { return plan_.last_frame - plan_.first_frame + 1; }
  const WritePlan& plan() const { return plan_; }
  /// All that stands above the rows.
  virtual std::string head(const RecordingHeader& header) const = 0;
  /// Adds a row, with its end; `points` has one for each of the plan's tracks, null where it is missing.
  virtual void append_row(std::string& text, std::int64_t index, Timestamp time, std::span<const Sample* const> points) const = 0;

 private:
  void start(const RecordingHeader& header) final;
  void put(std::int64_t index, Timestamp time, std::span<const Sample> points);
  /// Rows of nothing up to `index`, whose time, where it is known, bounds theirs: between two known times they are spread evenly,
  /// before the first and after the last by the rate.
  void fill_to(std::int64_t index, std::optional<Timestamp> time);

  WritePlan plan_;
  std::optional<WholeFile> file_;
  std::vector<const Sample*> row_;
  std::map<TrackId, std::size_t> column_;
  double rate_hz_ = 1;
  std::int64_t next_ = 0;
  std::optional<Timestamp> last_time_;  ///< of the row before next_, where that was an instant
  std::string text_;
};

}  // namespace marey::format::motion
