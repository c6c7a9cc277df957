#include "marey/format/motion/trc.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/text_safety.h"
#include "marey/core/whole_file.h"
#include "marey/format/motion/length_unit.h"
#include "marey/format/motion/wide_table.h"

namespace marey::format::motion {
namespace {

/// The five lines above the rows.
class TrcHead {
 public:
  TrcHead(std::string_view text, std::string name) : name_(std::move(name)), lines_(text) {}

  std::unique_ptr<MotionReader> reader(std::unique_ptr<MappedFile> file) {
    const std::string_view first = line("its first line");
    if (!first.starts_with("PathFileType")) fail("begins not with PathFileType, as a TRC file does");
    table_.separator = first.find('\t') != std::string_view::npos ? '\t' : ',';
    values();
    names();
    // X1 Y1 Z1 …; some programs put a blank line behind it, which reads as a row of nothing.
    line("its line of axes");
    table_.rows = lines_.rest();
    table_.first_line = lines_.number() + 1;
    return std::make_unique<WideTableReader>(std::move(file), name_, std::move(table_), std::move(info_), std::move(warnings_));
  }

 private:
  std::string_view line(const char* which) {
    std::string_view text;
    if (!lines_.next(text)) throw Error("{}: ends before {}; the file is cut off", name_, which);
    return text;
  }

  void values() {
    std::vector<std::string_view> keys, values;
    split_fields(line("DataRate and the other names of values"), table_.separator, keys);
    split_fields(line("its values"), table_.separator, values);
    std::map<std::string_view, std::string_view> by_key;
    for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) by_key.emplace(keys[i], values[i]);
    const auto rate = number_of(by_key["DataRate"]);
    if (!rate || *rate <= 1e-6 || *rate > 1e9)
      fail(fmt::format("DataRate is {}; it must be frames per second", shown(by_key["DataRate"])));
    info_.header.rate_hz = *rate;
    info_.frame_count = whole_number_of(by_key["NumFrames"]);
    markers_ = whole_number_of(by_key["NumMarkers"]);
    const auto unit = metres_of_unit(by_key["Units"]);
    if (!unit) warn(fmt::format("its unit {} is not known; mm is assumed", shown(by_key["Units"])));
    table_.unit_m = unit.value_or(0.001);
  }

  /// A name stands over the first of its three columns; in some files the names stand side by side instead.
  void names() {
    std::vector<std::string_view> fields;
    split_fields(line("the names of its markers"), table_.separator, fields);
    if (fields.size() < 2) fail("has no names of markers where Frame# and Time should stand");
    table_.frame_column = 0;
    table_.time_column = 1;
    fields.erase(fields.begin(), fields.begin() + 2);
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    const auto named =
        static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), [](auto field) { return !field.empty(); }));
    const bool side_by_side = named > 1 && named == fields.size();
    const std::size_t step = side_by_side ? 1 : 3;
    for (std::size_t i = 0; i < fields.size(); i += step) {
      const auto track = static_cast<int>(info_.tracks.size());
      info_.tracks.push_back({TrackId(track + 1), unquoted(fields[i]), {}});
      table_.x_columns.push_back(2 + 3 * static_cast<std::size_t>(track));
    }
    if (markers_ && *markers_ != static_cast<std::int64_t>(info_.tracks.size())) {
      warn(fmt::format("says that it has {} markers, and names {}", *markers_, info_.tracks.size()));
    }
  }

  void warn(const std::string& sentence) { warnings_.push_back(name_ + ": " + sentence); }
  [[noreturn]] void fail(const std::string& what) const { throw Error("{}:{}: {}", name_, lines_.number(), what); }

  std::string name_;
  TextLines lines_;
  WideTable table_;
  MotionInfo info_;
  std::optional<std::int64_t> markers_;
  std::vector<std::string> warnings_;
};

class TrcWriter : public MotionSink {
 public:
  TrcWriter(const std::string& path, const MotionPlan& plan) : MotionSink(path), plan_(plan), row_(plan.info.tracks.size()) {}

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
    std::string head = fmt::format("PathFileType\t4\t(X/Y/Z)\t{}\n", std::filesystem::path(path()).filename().string());
    head += "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n";
    head += fmt::format("{0}\t{0}\t{1}\t{2}\tmm\t{0}\t{3}\t{1}\n", header.rate_hz, frames, row_.size(), plan_.first_frame + 1);
    head += "Frame#\tTime";
    std::string axes = "\t";
    for (std::size_t i = 0; i < row_.size(); ++i) {
      const TrackName& track = plan_.info.tracks[i];
      column_[track.id] = i;
      head += fmt::format("\t{}\t\t", track.label.empty() ? fmt::format("unnamed_{}", number(track.id)) : one_word(track.label));
      axes += fmt::format("\tX{0}\tY{0}\tZ{0}", i + 1);
    }
    file_->write(head + "\n" + axes + "\n\n");
    next_ = plan_.first_frame;
    rate_hz_ = header.rate_hz;
  }

  /// Readers cut at tabs, and some at blanks too.
  static std::string one_word(std::string label) {
    label = plain_text(label);
    for (char& c : label) {
      if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    }
    return label;
  }

  void put(std::int64_t index, Timestamp time, std::span<const Sample> points) {
    std::fill(row_.begin(), row_.end(), nullptr);
    for (const Sample& point : points) {
      const auto column = column_.find(point.track);
      if (column != column_.end()) row_[column->second] = &point;
    }
    line_.clear();
    auto out = std::back_inserter(line_);
    fmt::format_to(out, "{}\t{:.9g}", index + 1, seconds(time));
    for (const Sample* point : row_) {
      if (point == nullptr) {
        line_ += "\t\t\t";
      } else {
        fmt::format_to(out, "\t{:.10g}\t{:.10g}\t{:.10g}", point->position.x() * 1000, point->position.y() * 1000,
                       point->position.z() * 1000);
      }
    }
    line_ += "\t\n";  // OpenSim loses a last cell that is blank, and writes its own rows so
    file_->write(line_);
    next_ = index + 1;
  }

  MotionPlan plan_;
  std::optional<WholeFile> file_;
  std::vector<const Sample*> row_;
  std::map<TrackId, std::size_t> column_;
  std::int64_t next_ = 0;
  double rate_hz_ = 1;
  std::string line_;
};

}  // namespace

std::unique_ptr<MotionReader> open_trc(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return TrcHead(file->text(), path).reader(std::move(file));
}

std::unique_ptr<MotionReader> read_trc(std::string_view text, const std::string& name) {
  return TrcHead(text, name).reader(nullptr);
}

std::unique_ptr<Sink> create_trc(const std::string& path, const MotionPlan& plan) {
  return std::make_unique<TrcWriter>(path, plan);
}

}  // namespace marey::format::motion
