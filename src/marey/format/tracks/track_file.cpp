#include "marey/format/tracks/track_file.h"

#include <array>
#include <cassert>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/take/take_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/tracks/outline_json.h"

namespace marey::format::tracks {
namespace {

struct NamedFormat {
  TrackFormat format;
  std::string_view name;
  std::string_view ending;
};
constexpr std::array kFormats{NamedFormat{TrackFormat::mot, "mot", ".txt"}, NamedFormat{TrackFormat::csv, "csv", ".csv"},
                              NamedFormat{TrackFormat::jsonl, "jsonl", ".jsonl"}, NamedFormat{TrackFormat::take, "take", ".marey"}};

std::string_view state_of(const Sample& sample) {
  return sample.measured() ? "observed" : "predicted";
}

void append_mot(std::string& lines, const Instant& instant, const Sample& sample) {
  if (!sample.box) return;
  const Box& box = *sample.box;
  fmt::format_to(std::back_inserter(lines), "{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.4g},-1,-1,-1\n", instant.index + 1,
                 number(sample.track), box.left + 1, box.top + 1, box.width, box.height,
                 sample.measured() ? sample.score.value_or(1) : 0.0);
}

void append_csv(std::string& lines, const Instant& instant, const Sample& sample, const std::string& label) {
  auto out = std::back_inserter(lines);
  fmt::format_to(out, "{},{:.6f},{},{},{:.3f},{:.3f},", instant.index, seconds(instant.time), number(sample.track),
                 quoted_field(label), sample.position.x(), sample.position.y());
  if (sample.velocity) {
    fmt::format_to(out, "{:.2f},{:.2f},", sample.velocity->x(), sample.velocity->y());
  } else {
    lines += ",,";
  }
  if (sample.box) {
    fmt::format_to(out, "{:.2f},{:.2f},{:.2f},{:.2f},", sample.box->left, sample.box->top, sample.box->width, sample.box->height);
  } else {
    lines += ",,,,";
  }
  fmt::format_to(out, "{}\n", state_of(sample));
}

void append_json(std::string& lines, const Instant& instant, const Sample& sample, const std::string& label) {
  auto out = std::back_inserter(lines);
  fmt::format_to(out, R"({{"frame":{},"time":{:.6f},"id":{},)", instant.index, seconds(instant.time), number(sample.track));
  if (!label.empty()) {
    using nlohmann::json;
    fmt::format_to(out, R"("label":{},)", json(label).dump(-1, ' ', false, json::error_handler_t::replace));
  }
  fmt::format_to(out, R"("x":{:.3f},"y":{:.3f},)", sample.position.x(), sample.position.y());
  if (sample.velocity) fmt::format_to(out, R"("vx":{:.2f},"vy":{:.2f},)", sample.velocity->x(), sample.velocity->y());
  if (sample.box) {
    fmt::format_to(out, R"("left":{:.2f},"top":{:.2f},"width":{:.2f},"height":{:.2f},)", sample.box->left, sample.box->top,
                   sample.box->width, sample.box->height);
  }
  fmt::format_to(out, R"("state":"{}")", state_of(sample));
  if (sample.outline) {
    lines += R"(,"outline":)";
    tracks::append_json(lines, *sample.outline);
  }
  lines += "}\n";
}

}  // namespace

std::string track_format_names() {
  std::string names;
  for (const NamedFormat& format : kFormats) names.append(names.empty() ? "" : ", ").append(format.name);
  return names;
}

TrackFormat parse_track_format(std::string_view name) {
  for (const NamedFormat& format : kFormats) {
    if (format.name == name) return format.format;
  }
  throw Error("\"{}\" is no format of tracks; these are: {}", name, track_format_names());
}

std::optional<TrackFormat> track_format_of(std::string_view path) {
  for (const NamedFormat& format : kFormats) {
    if (path.ends_with(format.ending)) return format.format;
  }
  return std::nullopt;
}

std::string_view ending_of(TrackFormat format) {
  for (const NamedFormat& named : kFormats) {
    if (named.format == format) return named.ending;
  }
  return {};
}

std::unique_ptr<Sink> create_tracks(const std::string& path, TrackFormat format) {
  if (format == TrackFormat::take) return std::make_unique<take::TakeWriter>(path);
  return std::make_unique<TrackFile>(path, format);
}

TrackFile::TrackFile(const std::string& path, TrackFormat format) : path_(path), file_(path), format_(format) {}

Sink::Wants TrackFile::begin(const RecordingHeader& header) {
  if (header.frame.metric()) {
    throw Error("{}: {} holds boxes in a picture, and these positions are {}", path_, track_format_names(),
                to_string(header.frame));
  }
  if (format_ == TrackFormat::csv) file_.write("frame,time,id,label,x,y,vx,vy,left,top,width,height,state\n");
  return {};
}

void TrackFile::write(const Instant& instant) {
  names_.add(instant.named);
  lines_.clear();
  for (const Sample& sample : instant.samples) {
    switch (format_) {
      case TrackFormat::mot:
        append_mot(lines_, instant, sample);
        break;
      case TrackFormat::csv:
        append_csv(lines_, instant, sample, names_.label(sample.track));
        break;
      case TrackFormat::jsonl:
        append_json(lines_, instant, sample, names_.label(sample.track));
        break;
      case TrackFormat::take:
        assert(!"a take is no text: create_tracks knows its writer");
    }
  }
  file_.write(lines_);
}

}  // namespace marey::format::tracks
