// Motive's export: one line of settings as pairs, then lines of headings over the columns (Type, Name, ID, sometimes Parent, and
// the quantity), then "Frame,Time (Seconds),X,Y,Z,…" and the rows. Versions differ in how many headings there are and whether
// their first cells are named, so each heading is known by what stands in it. Reference: OptiTrack, "Data Export: CSV".
#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/motion/length_unit.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/wide_table.h"

namespace marey::format::motion {
namespace {

constexpr int kMaxHeadings = 12;

class MotiveHead : private WideTableHead {
 public:
  using WideTableHead::WideTableHead;

  std::unique_ptr<FileReader> reader(std::unique_ptr<MappedFile> file) {
    settings();
    headings();
    columns();
    return rows_of(std::move(file));
  }

 private:
  using Cells = std::vector<std::string>;

  void settings() {
    if (!next_line() || fields_.front() != "Format Version") fail("begins not with \"Format Version\", as a file of Motive's does");
    std::map<std::string, std::string> by_key;
    for (std::size_t i = 0; i + 1 < fields_.size(); i += 2) by_key[unquoted(fields_[i])] = unquoted(fields_[i + 1]);
    auto rate = number_of(by_key["Export Frame Rate"]);
    if (!rate) rate = number_of(by_key["Capture Frame Rate"]);
    set_rate(rate, "does not specify its Export Frame Rate in frames per second");
    info_.header.name = by_key["Take Name"];
    info_.header.made_by.program = "Motive";
    info_.frame_count = whole_number_of(by_key["Total Exported Frames"]);
    const std::string& unit = by_key["Length Units"];
    const auto metres = metres_of_unit(unit);
    if (!metres) warn(fmt::format("its unit {} is not known; metres are assumed", shown(unit)));
    table_.unit_m = metres.value_or(1);
    table_.first_frame_number = 0;
  }

  /// Up to the line that begins with "Frame".
  void headings() {
    for (int i = 0; i < kMaxHeadings && next_line(); ++i) {
      Cells cells;
      for (const std::string_view field : fields_) cells.push_back(unquoted(field));
      if (cells.front() == "Frame") {
        axes_ = std::move(cells);
        return;
      }
      if (holds(cells, "Marker") || holds(cells, "Rigid Body") || holds(cells, "Bone")) {
        types_ = std::move(cells);
      } else if (holds(cells, "Position")) {
        kinds_ = std::move(cells);
      } else if (names_.empty() && cells.size() > 2) {
        names_ = std::move(cells);
      }
    }
    fail("has no line that begins with \"Frame\"; it is cut off");
  }

  void columns() {
    table_.frame_column = 0;
    if (axes_.size() > 1 && axes_[1].starts_with("Time")) table_.time_column = 1;
    for (std::size_t i = 2; i + 2 < axes_.size(); ++i) {
      if (axes_[i] != "X" || axes_[i + 1] != "Y" || axes_[i + 2] != "Z") continue;
      const std::string type = cell(types_, i);
      if (cell(kinds_, i) == "Rotation") {
        if (type == "Rigid Body" || type == "Bone") find_body(i);
      } else if (is_marker(type)) {
        add_marker(cell(names_, i), i);
      }
    }
    if (table_.x_columns.empty()) add_body_markers();
    if (table_.x_columns.empty() && table_.bodies.empty()) warn("holds no marker");
  }

  /// Where no marker was exported as measured: those of bodies and bones as they were solved.
  void add_body_markers() {
    for (std::size_t i = 2; i + 2 < axes_.size(); ++i) {
      if (cell(types_, i).ends_with(" Marker") && axes_[i] == "X" && axes_[i + 1] == "Y" && axes_[i + 2] == "Z")
        add_marker(cell(names_, i), i);
    }
    if (!table_.x_columns.empty()) warn("has no measured markers; those of its bodies as they were solved are read");
  }

  /// A rotation X, Y, Z, W and the position that follows it, of one name. Turns as three angles are not read.
  void find_body(std::size_t i) {
    if (i + 6 >= axes_.size() || axes_[i + 3] != "W" || cell(kinds_, i + 4) != "Position" ||
        cell(names_, i + 4) != cell(names_, i)) {
      if (!std::exchange(angles_, true))
        warn("rotations of its bodies are not quaternions; they are omitted, export with the rotation type Quaternion");
      return;
    }
    add_body(cell(names_, i), {.position_column = i + 4, .rotation_column = i, .rotation = WideBody::Rotation::quaternion_xyzw});
  }

  /// What is on a body is written twice by some versions, as measured and as solved; the measured one is the marker.
  static bool is_marker(const std::string& type) { return type.empty() || type == "Marker"; }
  static bool holds(const Cells& cells, std::string_view word) {
    return std::find(cells.begin(), cells.end(), word) != cells.end();
  }
  static std::string cell(const Cells& cells, std::size_t i) { return i < cells.size() ? cells[i] : std::string(); }

  Cells types_, names_, kinds_, axes_;
  bool angles_ = false;  // a body without a quaternion was met
};

class MotiveWriter : public WideTableWriter {
 public:
  using WideTableWriter::WideTableWriter;

 private:
  std::string head(const RecordingHeader& header) const override {
    std::string head = fmt::format(
        "Format Version,1.23,Take Name,{},Take Notes,,Capture Frame Rate,{:.6f},Export Frame Rate,{:.6f},"
        "Capture Start Time,,Capture Start Frame,{},Total Frames in Take,{},Total Exported Frames,{},"
        "Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\n",
        quoted_field(header.name), header.rate_hz, header.rate_hz, plan().first_frame, frames(), frames());
    std::string types = ",Type", names = ",Name", ids = ",ID", kinds = ",", axes = "Frame,Time (Seconds)";
    for (const TrackName& track : plan().info.tracks) {
      const std::string name = quoted_field(track.label.empty() ? fmt::format("Unlabeled {}", number(track.id)) : track.label);
      for (const char* axis : {",X", ",Y", ",Z"}) {
        types += ",Marker";
        names += "," + name;
        ids += fmt::format(",{:08X}", static_cast<unsigned>(number(track.id)));
        kinds += ",Position";
        axes += axis;
      }
    }
    for (const std::string* line : {&types, &names, &ids, &kinds, &axes}) head += *line + "\n";
    return head;
  }

  void append_row(std::string& text, std::int64_t index, Timestamp time, std::span<const Sample* const> points) const override {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},{:.9g}", index, seconds(time));
    for (const Sample* point : points) {
      if (point == nullptr) {
        text += ",,,";
      } else {
        fmt::format_to(out, ",{:.10g},{:.10g},{:.10g}", point->position.x(), point->position.y(), point->position.z());
      }
    }
    text += '\n';
  }
};

}  // namespace

std::unique_ptr<FileReader> open_motive_csv(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return MotiveHead(file->text(), path).reader(std::move(file));
}
std::unique_ptr<FileReader> read_motive_csv(std::string_view text, const std::string& name) {
  return MotiveHead(text, name).reader(nullptr);
}
std::unique_ptr<Sink> create_motive_csv(const std::string& path, const WritePlan& plan) {
  return std::make_unique<MotiveWriter>(path, plan);
}

Format motive_format() {
  return {.name = "motive",
          .title = "a CSV file of Motive's",
          .endings = {},
          .holds = Content::space,
          .detail = "m; points and bodies' poses, as OptiTrack's Motive exports them: one row a frame. Points are written",
          .is = [](const Beginning& file) { return file.text().starts_with("Format Version"); },
          .open = [](const std::string& path, const ReadOptions&) { return motion::open_motive_csv(path); },
          .create = [](const std::string& path, const WritePlan& plan) { return motion::create_motive_csv(path, plan); }};
}

}  // namespace marey::format::motion
