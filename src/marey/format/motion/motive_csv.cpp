// Motive's export: one line of settings as pairs, then lines of headings over the columns (Type, Name, ID, sometimes Parent, and
// what is measured), then "Frame,Time (Seconds),X,Y,Z,…" and the rows. Versions differ in how many headings there are and whether
// their first cells are named, so each heading is known by what stands in it. Reference: OptiTrack, "Data Export: CSV".
#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/format/motion/length_unit.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/wide_table.h"

namespace marey::format::motion {
namespace {

constexpr int kMostHeadings = 12;

class MotiveHead {
 public:
  MotiveHead(std::string_view text, std::string name) : name_(std::move(name)), lines_(text) {}

  std::unique_ptr<MotionReader> reader(std::unique_ptr<MappedFile> file) {
    settings();
    headings();
    columns();
    table_.rows = lines_.rest();
    table_.first_line = lines_.number() + 1;
    return std::make_unique<WideTableReader>(std::move(file), name_, std::move(table_), std::move(info_), std::move(warnings_));
  }

 private:
  using Cells = std::vector<std::string>;

  bool next_line() {
    std::string_view line;
    if (!lines_.next(line)) return false;
    split_fields(line, ',', fields_);
    return true;
  }

  void settings() {
    if (!next_line() || fields_.front() != "Format Version") fail("begins not with \"Format Version\", as a file of Motive's does");
    std::map<std::string, std::string> by_key;
    for (std::size_t i = 0; i + 1 < fields_.size(); i += 2) by_key[unquoted(fields_[i])] = unquoted(fields_[i + 1]);
    auto rate = number_of(by_key["Export Frame Rate"]);
    if (!rate) rate = number_of(by_key["Capture Frame Rate"]);
    if (!rate || *rate <= 1e-6 || *rate > 1e9) fail("does not say its Export Frame Rate in frames per second");
    info_.header.rate_hz = *rate;
    info_.header.name = by_key["Take Name"];
    info_.header.made_by.program = "Motive";
    info_.frame_count = whole_number_of(by_key["Total Exported Frames"]);
    const std::string& unit = by_key["Length Units"];
    const auto metres = metres_of_unit(unit);
    if (!metres) warnings_.push_back(fmt::format("{}: its unit {} is not known; metres are assumed", name_, shown(unit)));
    table_.unit_m = metres.value_or(1);
    table_.first_frame_number = 0;
  }

  /// Up to the line that begins with "Frame".
  void headings() {
    for (int i = 0; i < kMostHeadings && next_line(); ++i) {
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
      if (cell(kinds_, i) == "Rotation" || !is_marker(cell(types_, i))) continue;
      const auto id = static_cast<int>(info_.tracks.size()) + 1;
      info_.tracks.push_back({TrackId(id), cell(names_, i), {}});
      table_.x_columns.push_back(i);
    }
    if (table_.x_columns.empty()) warnings_.push_back(name_ + ": holds no marker");
  }

  /// What is on a body is written twice by some versions, as measured and as solved; the measured one is the marker.
  static bool is_marker(const std::string& type) { return type.empty() || type == "Marker"; }
  static bool holds(const Cells& cells, std::string_view word) {
    return std::find(cells.begin(), cells.end(), word) != cells.end();
  }
  static std::string cell(const Cells& cells, std::size_t i) { return i < cells.size() ? cells[i] : std::string(); }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error("{}:{}: {}", name_, std::max<std::size_t>(lines_.number(), 1), what);
  }

  std::string name_;
  TextLines lines_;
  std::vector<std::string_view> fields_;
  Cells types_, names_, kinds_, axes_;
  WideTable table_;
  MotionInfo info_;
  std::vector<std::string> warnings_;
};

class MotiveWriter : public MotionSink {
 public:
  MotiveWriter(const std::string& path, const MotionPlan& plan) : MotionSink(path), plan_(plan), row_(plan.info.tracks.size()) {}

  void write(const Instant& frame) override {
    while (next_ < frame.index) put(next_, timestamp_from_seconds(static_cast<double>(next_) / rate_hz_), {});
    put(frame.index, frame.time, frame.samples);
  }
  void finish() override {
    while (next_ <= plan_.last_frame) put(next_, timestamp_from_seconds(static_cast<double>(next_) / rate_hz_), {});
    file_->finish();
  }

 private:
  void start(const RecordingHeader& header) override {
    file_.emplace(path());
    const std::int64_t frames = plan_.last_frame - plan_.first_frame + 1;
    file_->write(
        fmt::format("Format Version,1.23,Take Name,{},Take Notes,,Capture Frame Rate,{:.6f},Export Frame Rate,{:.6f},"
                    "Capture Start Time,,Capture Start Frame,{},Total Frames in Take,{},Total Exported Frames,{},"
                    "Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\n",
                    quoted_field(header.name), header.rate_hz, header.rate_hz, plan_.first_frame, frames, frames));
    std::string types = ",Type", names = ",Name", ids = ",ID", kinds = ",", axes = "Frame,Time (Seconds)";
    for (std::size_t i = 0; i < row_.size(); ++i) {
      const TrackName& track = plan_.info.tracks[i];
      column_[track.id] = i;
      const std::string name = quoted_field(track.label.empty() ? fmt::format("Unlabeled {}", number(track.id)) : track.label);
      for (const char* axis : {",X", ",Y", ",Z"}) {
        types += ",Marker";
        names += "," + name;
        ids += fmt::format(",{:08X}", static_cast<unsigned>(number(track.id)));
        kinds += ",Position";
        axes += axis;
      }
    }
    for (const std::string* line : {&types, &names, &ids, &kinds, &axes}) file_->write(*line + "\n");
    rate_hz_ = header.rate_hz;
    next_ = plan_.first_frame;
  }

  void put(std::int64_t index, Timestamp time, std::span<const Sample> points) {
    std::fill(row_.begin(), row_.end(), nullptr);
    for (const Sample& point : points) {
      const auto column = column_.find(point.track);
      if (column != column_.end()) row_[column->second] = &point;
    }
    line_.clear();
    auto out = std::back_inserter(line_);
    fmt::format_to(out, "{},{:.9g}", index, seconds(time));
    for (const Sample* point : row_) {
      if (point == nullptr) {
        line_ += ",,,";
      } else {
        fmt::format_to(out, ",{:.10g},{:.10g},{:.10g}", point->position.x(), point->position.y(), point->position.z());
      }
    }
    line_ += '\n';
    file_->write(line_);
    next_ = index + 1;
  }

  MotionPlan plan_;
  std::optional<WholeFile> file_;
  std::vector<const Sample*> row_;
  std::map<TrackId, std::size_t> column_;
  double rate_hz_ = 1;
  std::int64_t next_ = 0;
  std::string line_;
};

}  // namespace

std::unique_ptr<MotionReader> open_motive_csv(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return MotiveHead(file->text(), path).reader(std::move(file));
}
std::unique_ptr<MotionReader> read_motive_csv(std::string_view text, const std::string& name) {
  return MotiveHead(text, name).reader(nullptr);
}
std::unique_ptr<Sink> create_motive_csv(const std::string& path, const MotionPlan& plan) {
  return std::make_unique<MotiveWriter>(path, plan);
}

}  // namespace marey::format::motion
