// Qualisys Track Manager's TSV export: lines of a name and its values, "NO_OF_FRAMES 100", then perhaps a line of column headings,
// then the rows. 3D data are x, y, z of each of MARKER_NAMES; 6D data x, y, z, three angles, the residual and the nine numbers of
// the rotation matrix, column by column, of each of BODY_NAMES. mm and degrees. A missing point is blank or three zeros, as was
// chosen. Reference: QTM user manual, "TSV file formats".
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/wide_table.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kBodyColumns = 16;  // format
constexpr std::size_t kBodyMatrix = 7;    // format: the first of its nine columns
constexpr std::array<std::string_view, 13> kTsvKeys = {
    "NO_OF_FRAMES", "NO_OF_CAMERAS", "NO_OF_MARKERS", "NO_OF_BODIES", "FREQUENCY",        "NO_OF_ANALOG", "ANALOG_FREQUENCY",
    "DESCRIPTION",  "TIME_STAMP",    "DATA_INCLUDED", "EVENT",        "TRAJECTORY_TYPES", "REFERENCE"};

class QualisysHead : private WideTableHead {
 public:
  using WideTableHead::WideTableHead;

  std::unique_ptr<FileReader> reader(std::unique_ptr<MappedFile> file) {
    table_.separator = '\t';
    table_.frame_column.reset();
    table_.zeros_are_missing = true;
    table_.unit_m = 0.001;
    values();
    set_rate(rate_, "has no FREQUENCY in frames per second");
    if (names_.empty()) fail("has neither MARKER_NAMES nor BODY_NAMES; of QTM's TSV files 3D and 6D data are read");
    info_.header.made_by.program = "Qualisys Track Manager";
    columns();
    return rows_of(std::move(file));
  }

 private:
  /// Up to the first line that begins neither with a name of a value nor with the headings of columns.
  void values() {
    std::string_view rest = lines_.rest();
    std::size_t line_number = lines_.number();
    while (next_line()) {
      const std::string_view key = fields_.empty() ? std::string_view() : fields_.front();
      if (!take(key)) break;
      rest = lines_.rest();
      line_number = lines_.number();
    }
    lines_.go_to(rest, line_number + 1);
  }

  /// False if the line is a row of numbers.
  bool take(std::string_view key) {
    if (key == "MARKER_NAMES" || key == "BODY_NAMES") {
      bodies_ = key == "BODY_NAMES";
      names_.clear();
      for (std::size_t i = 1; i < fields_.size(); ++i) {
        if (!fields_[i].empty()) names_.push_back(unquoted(fields_[i]));
      }
      return true;
    }
    const std::string_view value = fields_.size() > 1 ? fields_[1] : std::string_view();
    if (key == "FREQUENCY") rate_ = number_of(value);
    if (key == "NO_OF_FRAMES") info_.frame_count = whole_number_of(value);
    if (std::find(kTsvKeys.begin(), kTsvKeys.end(), key) != kTsvKeys.end()) return true;
    if (key == "Frame" || key == "Time") {  // headings of columns
      lead_ = fields_.size() > 1 && fields_[1] == "Time" ? 2 : 1;
      if (key == "Frame") table_.frame_column = 0;
      if (key == "Time" || lead_ == 2) table_.time_column = lead_ - 1;
      return true;
    }
    return !key.empty() && !number_of(key) && !is_number_row();  // a heading that this table does not have, or names of columns
  }

  bool is_number_row() const {
    return std::any_of(fields_.begin(), fields_.end(), [](std::string_view field) { return number_of(field).has_value(); });
  }

  void columns() {
    const std::size_t width = bodies_ ? kBodyColumns : 3;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::size_t first = lead_ + width * i;
      if (bodies_) {
        add_body(
            names_[i],
            {.position_column = first, .rotation_column = first + kBodyMatrix, .rotation = WideBody::Rotation::matrix_by_columns});
      } else {
        add_marker(names_[i], first);
      }
    }
  }

  std::optional<double> rate_;
  std::vector<std::string> names_;
  bool bodies_ = false;
  std::size_t lead_ = 0;  // columns before the first marker or body
};

}  // namespace

std::unique_ptr<FileReader> open_qualisys_tsv(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return QualisysHead(file->text(), path).reader(std::move(file));
}
std::unique_ptr<FileReader> read_qualisys_tsv(std::string_view text, const std::string& name) {
  return QualisysHead(text, name).reader(nullptr);
}

Format qualisys_tsv_format() {
  return {
      .name = "qualisys-tsv",
      .title = "a TSV file of Qualisys Track Manager's",
      .endings = {},
      .holds = Content::space,
      .detail = "mm; markers (3D) or rigid bodies' poses (6D), as Qualisys Track Manager exports them. Untested on a maker's file",
      .is = [](const Beginning& file) { return file.text().starts_with("NO_OF_FRAMES"); },
      .open = [](const std::string& path, const ReadOptions&) { return motion::open_qualisys_tsv(path); },
      .poses = true};
}

}  // namespace marey::format::motion
