#include "marey/format/motion/trc.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/motion/length_unit.h"
#include "marey/format/motion/wide_table.h"

namespace marey::format::motion {
namespace {

/// The five lines above the rows.
class TrcHead : private WideTableHead {
 public:
  using WideTableHead::WideTableHead;

  std::unique_ptr<FileReader> reader(std::unique_ptr<MappedFile> file) {
    std::string_view first;
    if (!lines_.next(first)) throw Error("{}: ends before its first line; the file is cut off", name_);
    if (!first.starts_with("PathFileType")) fail("begins not with PathFileType, as a TRC file does");
    table_.separator = first.find('\t') != std::string_view::npos ? '\t' : ',';
    values();
    names();
    // X1 Y1 Z1 …; some programs put a blank line behind it, which reads as a row of nothing.
    line("its line of axes");
    return rows_of(std::move(file));
  }

 private:
  void values() {
    const std::vector<std::string_view> keys = line("DataRate and the other names of values");
    const std::vector<std::string_view>& values = line("its values");
    std::map<std::string_view, std::string_view> by_key;
    for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) by_key.emplace(keys[i], values[i]);
    set_rate(number_of(by_key["DataRate"]), fmt::format("DataRate is {}; it must be frames per second", shown(by_key["DataRate"])));
    info_.frame_count = whole_number_of(by_key["NumFrames"]);
    markers_ = whole_number_of(by_key["NumMarkers"]);
    const auto unit = metres_of_unit(by_key["Units"]);
    if (!unit) warn(fmt::format("its unit {} is not known; mm is assumed", shown(by_key["Units"])));
    table_.unit_m = unit.value_or(0.001);
  }

  /// A name stands over the first of its three columns; in some files the names stand side by side instead, in others tabs are
  /// doubled: where there are as many names as the file says it has markers, they follow each other whatever lies between.
  void names() {
    std::vector<std::string_view> fields = line("the names of its markers");
    if (fields.size() < 2) fail("has no names of markers where Frame# and Time should stand");
    table_.frame_column = 0;
    table_.time_column = 1;
    fields.erase(fields.begin(), fields.begin() + 2);
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    const auto named =
        static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), [](auto field) { return !field.empty(); }));
    if (markers_ && static_cast<std::int64_t>(named) == *markers_) std::erase_if(fields, [](auto field) { return field.empty(); });
    const bool side_by_side = named > 1 && named == fields.size();
    const std::size_t step = side_by_side ? 1 : 3;
    for (std::size_t i = 0; i < fields.size(); i += step) add_marker(unquoted(fields[i]), 2 + 3 * info_.tracks.size());
    if (markers_ && *markers_ != static_cast<std::int64_t>(info_.tracks.size())) {
      warn(fmt::format("says that it has {} markers, and names {}", *markers_, info_.tracks.size()));
    }
  }

  std::optional<std::int64_t> markers_;
};

class TrcWriter : public WideTableWriter {
 public:
  using WideTableWriter::WideTableWriter;

 private:
  std::string head(const RecordingHeader& header) const override {
    std::string head = fmt::format("PathFileType\t4\t(X/Y/Z)\t{}\n", std::filesystem::path(path()).filename().string());
    head += "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n";
    head += fmt::format("{0}\t{0}\t{1}\t{2}\tmm\t{0}\t{3}\t{1}\n", header.rate_hz, frames(), plan().info.tracks.size(),
                        plan().first_frame + 1);
    head += "Frame#\tTime";
    std::string axes = "\t";
    int count = 0;
    for (const TrackName& track : plan().info.tracks) {
      head += fmt::format("\t{}\t\t", track.label.empty() ? fmt::format("unnamed_{}", number(track.id)) : one_word(track.label));
      axes += fmt::format("\tX{0}\tY{0}\tZ{0}", ++count);
    }
    return head + "\n" + axes + "\n\n";
  }

  /// Readers cut at tabs, and some at blanks too.
  static std::string one_word(std::string label) {
    label = plain_text(label);
    for (char& c : label) {
      if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    }
    return label;
  }

  void append_row(std::string& text, std::int64_t index, Timestamp time, std::span<const Sample* const> points) const override {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{}\t{:.9g}", index + 1, seconds(time));
    for (const Sample* point : points) {
      if (point == nullptr) {
        text += "\t\t\t";
      } else {
        fmt::format_to(out, "\t{:.10g}\t{:.10g}\t{:.10g}", point->position.x() * 1000, point->position.y() * 1000,
                       point->position.z() * 1000);
      }
    }
    text += "\t\n";  // OpenSim loses a last cell that is blank, and writes its own rows so
  }
};

}  // namespace

std::unique_ptr<FileReader> open_trc(const std::string& path) {
  auto file = std::make_unique<MappedFile>(path);
  return TrcHead(file->text(), path).reader(std::move(file));
}

std::unique_ptr<FileReader> read_trc(std::string_view text, const std::string& name) {
  return TrcHead(text, name).reader(nullptr);
}

std::unique_ptr<Sink> create_trc(const std::string& path, const WritePlan& plan) {
  return std::make_unique<TrcWriter>(path, plan);
}

Format trc_format() {
  return {.name = "trc",
          .title = "a TRC file",
          .endings = ".trc",
          .holds = Content::space,
          .detail = "mm; points; a blank where one is missing. Read with tabs or commas and in the unit it says",
          .is = [](const Beginning& file) { return file.text().starts_with("PathFileType"); },
          .open = [](const std::string& path, const ReadOptions&) { return motion::open_trc(path); },
          .create = [](const std::string& path, const WritePlan& plan) { return motion::create_trc(path, plan); }};
}

}  // namespace marey::format::motion
