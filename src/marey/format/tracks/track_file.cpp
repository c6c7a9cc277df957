#include "marey/format/tracks/track_file.h"

#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/tracks/outline_json.h"

namespace marey::format::tracks {
namespace {

struct NamedFormat {
  TrackFormat format;
  std::string_view name;
  std::string_view ending;
};
constexpr std::array kFormats{NamedFormat{TrackFormat::mot, "mot", ".txt"}, NamedFormat{TrackFormat::csv, "csv", ".csv"},
                              NamedFormat{TrackFormat::jsonl, "jsonl", ".jsonl"}};

std::string_view name_of(Track<2>::State state) {
  return state == Track<2>::State::observed ? "observed" : "predicted";
}

/// A CSV field as RFC 4180 quotes it.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

void append_mot(std::string& lines, std::int64_t frame, const Track<2>& track) {
  if (!track.box) return;
  const Box& box = *track.box;
  fmt::format_to(std::back_inserter(lines), "{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.4g},-1,-1,-1\n", frame + 1, number(track.id),
                 box.left + 1, box.top + 1, box.width, box.height, track.score);
}

void append_csv(std::string& lines, std::int64_t frame, Timestamp time, const Track<2>& track) {
  auto out = std::back_inserter(lines);
  fmt::format_to(out, "{},{:.6f},{},{},{:.3f},{:.3f},{:.2f},{:.2f},", frame, seconds(time), number(track.id), quoted(track.label),
                 track.position.x(), track.position.y(), track.velocity.x(), track.velocity.y());
  if (track.box) {
    fmt::format_to(out, "{:.2f},{:.2f},{:.2f},{:.2f},", track.box->left, track.box->top, track.box->width, track.box->height);
  } else {
    lines += ",,,,";
  }
  fmt::format_to(out, "{}\n", name_of(track.state));
}

void append_json(std::string& lines, std::int64_t frame, Timestamp time, const Track<2>& track) {
  auto out = std::back_inserter(lines);
  fmt::format_to(out, R"({{"frame":{},"time":{:.6f},"id":{},)", frame, seconds(time), number(track.id));
  if (!track.label.empty()) {
    using nlohmann::json;
    fmt::format_to(out, R"("label":{},)", json(track.label).dump(-1, ' ', false, json::error_handler_t::replace));
  }
  fmt::format_to(out, R"("x":{:.3f},"y":{:.3f},"vx":{:.2f},"vy":{:.2f},)", track.position.x(), track.position.y(),
                 track.velocity.x(), track.velocity.y());
  if (track.box) {
    fmt::format_to(out, R"("left":{:.2f},"top":{:.2f},"width":{:.2f},"height":{:.2f},)", track.box->left, track.box->top,
                   track.box->width, track.box->height);
  }
  fmt::format_to(out, R"("state":"{}")", name_of(track.state));
  if (track.outline) {
    lines += R"(,"outline":)";
    tracks::append_json(lines, *track.outline);
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

TrackFile::TrackFile(const std::string& path, TrackFormat format) : file_(path), format_(format) {
  if (format == TrackFormat::csv) file_.write("frame,time,id,label,x,y,vx,vy,left,top,width,height,state\n");
}

void TrackFile::write(std::int64_t frame, Timestamp time, std::span<const Track<2>> tracks) {
  lines_.clear();
  for (const Track<2>& track : tracks) {
    switch (format_) {
      case TrackFormat::mot:
        append_mot(lines_, frame, track);
        break;
      case TrackFormat::csv:
        append_csv(lines_, frame, time, track);
        break;
      case TrackFormat::jsonl:
        append_json(lines_, frame, time, track);
        break;
    }
  }
  file_.write(lines_);
}

}  // namespace marey::format::tracks
