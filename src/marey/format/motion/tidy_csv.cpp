// Rows are first scanned once, for which markers there are, for the rate, and for whether frames come in order; then they are
// read again frame by frame. Where they do not come in order, their places are sorted: 24 bytes a row.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/point_sink.h"
#include "marey/format/text_rows.h"

namespace marey::format::motion {
namespace {

enum Column { frame, time, id, label, x, y, z, state, cameras, residual_px, residual_mm, column_count };
constexpr std::array<std::string_view, column_count> kColumns{"frame", "time",  "id",      "label",       "x",          "y",
                                                              "z",     "state", "cameras", "residual_px", "residual_mm"};
constexpr double kMaxSize = 1e9;

class TidyReader : public FileReader {
 public:
  TidyReader(std::unique_ptr<MappedFile> file, std::string_view text, std::string name)
      : file_(std::move(file)), name_(std::move(name)), lines_(text) {
    find_columns();
    rows_ = lines_.rest();
    scan();
    lines_.go_to(rows_, 2);
  }

  const FileInfo& info() const override { return info_; }

  std::optional<Instant> next() override {
    Instant result;
    bool begun = false;
    for (; pending_ || next_row(); pending_ = false) {
      const std::int64_t index = frame_index();
      if (begun && index != result.index) {
        pending_ = true;
        break;
      }
      if (!begun) {
        result.index = index;
        result.time = timestamp_from_seconds(time_of_row(index));
        begun = true;
      }
      result.samples.push_back(point());
    }
    if (!begun) return std::nullopt;
    check_once(result);
    return result;
  }

 private:
  void find_columns() {
    std::string_view line;
    if (!lines_.next(line)) throw Error("{}: is empty; expected is a header, frame,time,id,label,x,y,z", name_);
    split_fields(line, ',', fields_);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const auto known = std::find(kColumns.begin(), kColumns.end(), unquoted(fields_[i]));
      if (known != kColumns.end()) at_[static_cast<std::size_t>(known - kColumns.begin())] = i;
    }
    for (const Column needed : {frame, x, y, z}) {
      if (!at_[needed])
        fail(fmt::format("has no column \"{}\"; expected is a header, frame,time,id,label,x,y,z", kColumns[needed]));
    }
    if (!at_[id] && !at_[label]) fail("has neither a column \"id\" nor \"label\"");
  }

  /// The next row that is not blank, in the order of frames; its fields.
  bool next_row() {
    std::string_view line;
    if (!order_.empty()) {
      if (at_row_ == order_.size()) return false;
      const Location& location = order_[at_row_++];
      lines_.go_to(rows_.substr(location.offset), location.line);
    }
    do {
      if (!lines_.next(line)) return false;
    } while (line.find_first_not_of(" \t") == std::string_view::npos);
    split_fields(line, ',', fields_);
    return true;
  }

  std::string_view field(Column column) const {
    const auto& at = at_[column];
    return at && *at < fields_.size() ? fields_[*at] : std::string_view();
  }

  double number_in(Column column) const {
    const std::string_view text = field(column);
    const auto value = number_of(text);
    if (!value || std::abs(*value) > kMaxSize) {
      fail(fmt::format("{} is {}; it must be a number{}", kColumns[column], shown(text),
                       lines_.ended() ? "" : ", and the file ends here: it is cut off"));
    }
    return *value;
  }
  std::optional<double> number_if_any(Column column) const {
    if (field(column).empty()) return std::nullopt;
    return number_in(column);
  }

  std::int64_t frame_index() const {
    const double value = number_in(frame);
    if (value < 0 || value != std::floor(value)) fail(fmt::format("frame is {}; frames are whole numbers from 0", value));
    return static_cast<std::int64_t>(value);
  }

  double time_of_row(std::int64_t index) const {
    return number_if_any(time).value_or(static_cast<double>(index) / info_.header.rate_hz);
  }

  /// Whose row it is: by its id, else by its label.
  TrackId track_of_row() {
    if (at_[id]) {
      const double value = number_in(id);
      if (value < 1 || value > 2e9 || value != std::floor(value))
        fail(fmt::format("id is {}; ids are whole numbers from 1", value));
      const TrackId found{static_cast<int>(value)};
      labels_.try_emplace(found, plain_text(unquoted(field(label))));
      return found;
    }
    const auto [entry, is_new] = ids_.try_emplace(unquoted(field(label)), TrackId(static_cast<int>(ids_.size()) + 1));
    if (is_new) labels_[entry->second] = plain_text(entry->first);
    return entry->second;
  }

  Sample point() {
    Sample result;
    result.track = track_of_row();
    result.position = {number_in(x), number_in(y), number_in(z)};
    result.residual_px = number_if_any(residual_px);
    if (const auto mm = number_if_any(residual_mm)) result.residual_m = *mm / 1000;
    const std::string_view reported = field(state);
    if (!reported.empty()) {
      const auto provenance = provenance_of(reported);
      if (!provenance) fail(fmt::format("state is {}; it must be {}", shown(reported), fmt::join(kProvenanceNames, ", ")));
      result.provenance = *provenance;
    }
    result.cameras = camera_mask();
    return result;
  }

  /// Numbers of cameras, from 0, with blanks between them.
  CameraMask camera_mask() const {
    CameraMask mask = 0;
    std::vector<std::string_view> numbers;
    split_fields(field(cameras), ' ', numbers);
    for (const std::string_view text : numbers) {
      if (text.empty()) continue;
      const auto camera = whole_number_of(text);
      if (!camera || *camera < 0 || *camera > 63)
        fail(fmt::format("cameras holds {}; cameras are numbers from 0 to 63", shown(text)));
      mask |= CameraMask{1} << *camera;
    }
    return mask;
  }

  /// The first reading: tracks, rate, order.
  void scan() {
    std::optional<std::int64_t> first, last;
    bool in_order = true;
    FrameNumbers numbers;
    while (next_row()) {
      const std::int64_t index = frame_index();
      track_of_row();
      if (last && index < *last) in_order = false;
      numbers.add(index, number_if_any(time));
      first = std::min(first.value_or(index), index);
      last = std::max(last.value_or(index), index);
    }
    numbers.check(name_);
    info_.header.rate_hz = plain(numbers.rate_hz().value_or(100));
    if (first) info_.frame_count = *last - *first + 1;
    for (const auto& [track, text] : labels_) info_.tracks.push_back({track, text, {}});
    if (!in_order) sort_rows();
  }

  void sort_rows() {
    lines_.go_to(rows_, 2);
    std::vector<Location> locations;
    std::size_t begins = 0;
    while (begins = rows_.size() - lines_.rest().size(), next_row()) locations.push_back({frame_index(), begins, lines_.number()});
    std::stable_sort(locations.begin(), locations.end(), [](const Location& a, const Location& b) { return a.index < b.index; });
    order_ = std::move(locations);
  }

  /// Times have six decimals or so: a rate that is whole but for that is whole.
  static double plain(double rate) {
    const double rounded = std::round(rate * 1000) / 1000;
    return std::abs(rate - rounded) < 1e-4 * rounded ? rounded : rate;
  }

  void check_once(const Instant& result) const {
    std::set<TrackId> detected;
    for (const Sample& each : result.samples) {
      if (!detected.insert(each.track).second) {
        throw Error("{}: id {} stands twice in frame {}; it may stand once", name_, number(each.track), result.index);
      }
    }
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error("{}:{}: {}", name_, lines_.number(), what); }

  struct Location {
    std::int64_t index;
    std::size_t offset, line;
  };
  std::unique_ptr<MappedFile> file_;
  std::string name_;
  TextLines lines_;
  std::string_view rows_;
  std::array<std::optional<std::size_t>, column_count> at_;
  std::vector<std::string_view> fields_;
  std::map<TrackId, std::string> labels_;
  std::map<std::string, TrackId> ids_;
  std::vector<Location> order_;  // empty if rows come in the order of frames
  std::size_t at_row_ = 0;
  bool pending_ = false;  // the row at hand belongs to the next frame
  FileInfo info_;
};

class TidyWriter : public PointSink {
 public:
  using PointSink::PointSink;

  void write(const Instant& frame) override {
    for (const TrackName& track : frame.named) labels_[track.id] = quoted_field(track.label);
    lines_.clear();
    auto out = std::back_inserter(lines_);
    for (const Sample& point : frame.samples) {
      fmt::format_to(out, "{},{:.6f},{},{},{:.10g},{:.10g},{:.10g},{},{},", frame.index, seconds(frame.time), number(point.track),
                     labels_[point.track], point.position.x(), point.position.y(), point.position.z(), to_string(point.provenance),
                     numbers(point.cameras));
      if (point.residual_px) fmt::format_to(out, "{:.6g}", *point.residual_px);
      lines_ += ',';
      if (point.residual_m) fmt::format_to(out, "{:.6g}", *point.residual_m * 1000);
      lines_ += '\n';
    }
    file_->write(lines_);
  }
  void finish() override { file_->finish(); }

 private:
  void start(const RecordingHeader&) override {
    file_.emplace(path());
    file_->write("frame,time,id,label,x,y,z,state,cameras,residual_px,residual_mm\n");
  }

  static std::string numbers(CameraMask mask) {
    std::string text;
    for (int camera = 0; camera < 64; ++camera) {
      if ((mask >> camera & 1) != 0) fmt::format_to(std::back_inserter(text), "{}{}", text.empty() ? "" : " ", camera);
    }
    return text;
  }

  std::optional<WholeFile> file_;
  std::map<TrackId, std::string> labels_;
  std::string lines_;
};

}  // namespace

std::unique_ptr<FileReader> open_tidy_csv(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  const std::string_view text = file->text();
  return std::make_unique<TidyReader>(std::move(file), text, path);
}
std::unique_ptr<FileReader> read_tidy_csv(std::string_view text, const std::string& name) {
  return std::make_unique<TidyReader>(nullptr, text, name);
}
std::unique_ptr<Sink> create_tidy_csv(const std::string& path) {
  return std::make_unique<TidyWriter>(path);
}

Format tidy_csv_format() {
  return {.name = "csv",
          .title = "a CSV file of points, one row each",
          .endings = ".csv",
          .holds = Content::space,
          .detail =
              "m; one row a point: `frame,time,id,label,x,y,z,state,cameras,residual_px,residual_mm`; frames and cameras count "
              "from 0, the residual is in mm. Read with its columns and rows in any order; `frame,x,y,z` and one of `id`, "
              "`label` must be there",
          .is =
              [](const Beginning& file) {
                const std::string_view line = file.first_line();
                return line.starts_with("frame,") || line.find(",frame,") != std::string_view::npos;
              },
          .open = [](const std::string& path, const ReadOptions&) { return motion::open_tidy_csv(path); },
          .create = [](const std::string& path, const WritePlan&) { return motion::create_tidy_csv(path); },
          .while_recording = true};
}

}  // namespace marey::format::motion
