#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_exchange.h"
#include "marey/format/motion/motion.h"
#include "marey/format/rig/rig_exchange.h"
#include "marey/format/take/take_file.h"

#include "command_line.h"
#include "commands.h"
#include "info_ground.h"
#include "json_value.h"

namespace marey::cli {
namespace {

struct InfoOptions {
  std::string file;
  std::string metadata;
  bool json = false;
  bool quiet = false;
};

std::string_view words_of(format::motion::MotionFormat format) {
  switch (format) {
    case format::motion::MotionFormat::take:
      return "a take";
    case format::motion::MotionFormat::c3d:
      return "a C3D file";
    case format::motion::MotionFormat::trc:
      return "a TRC file";
    case format::motion::MotionFormat::csv:
      return "a CSV file of points, one row each";
    case format::motion::MotionFormat::motive:
      return "a CSV file of Motive's";
    case format::motion::MotionFormat::nexus:
      return "a CSV file of Nexus's";
  }
  return {};
}

/// 1,234,567
std::string counted(std::int64_t value) {
  std::string digits = fmt::format("{}", value);
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3) digits.insert(static_cast<std::size_t>(at), 1, ',');
  return digits;
}

std::string duration_words(double duration_s) {
  if (duration_s < 60) return fmt::format("{:.2f} s", duration_s);
  const auto minutes = static_cast<std::int64_t>(duration_s / 60);
  if (minutes < 60) return fmt::format("{} min {:.1f} s", minutes, duration_s - 60.0 * static_cast<double>(minutes));
  return fmt::format("{} h {} min {:.0f} s", minutes / 60, minutes % 60, duration_s - 60.0 * static_cast<double>(minutes));
}

std::string percent(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? std::string("-") : fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// All frames between the first and the last, those that are left out too.
std::int64_t span_of(const RecordingSummary& summary) {
  return summary.first_index ? *summary.last_index - *summary.first_index + 1 : 0;
}

void row_if_any(const char* name, const std::string& value) {
  if (!value.empty()) fmt::print("  {:<13} {}\n", name, value);
}

std::string camera_words(const RigCamera& camera, bool first) {
  std::string words = camera.size ? fmt::format("{}x{}", camera.size->width, camera.size->height) : std::string("size unknown");
  words += camera.camera()            ? ", calibrated"
           : camera.ground_from_image ? ", ground known"
           : camera.lens              ? ", lens known"
                                      : ", not calibrated";
  if (camera.rms_px) words += fmt::format(", {:.2f} px RMS", *camera.rms_px);
  if (camera.offset_s && *camera.offset_s != 0) words += fmt::format(", offset {:+.4f} s", *camera.offset_s);
  if (!camera.offset_s && !first) words += ", offset not known";
  if (!camera.source.empty()) return words + ", " + camera.source;
  return camera.detections.empty() ? words : words + ", detections " + camera.detections;
}

void print_cameras(const Rig& rig) {
  std::size_t width = 6;
  for (const RigCamera& camera : rig.cameras) width = std::max(width, camera.name.size());
  for (const RigCamera& camera : rig.cameras)
    fmt::print("  {:<{}}  {}\n", camera.name, width, camera_words(camera, &camera == rig.cameras.data()));
}

void print_calibration(const Rig& rig) {
  if (!rig.calibration) return;
  std::string words = rig.calibration->method;
  if (rig.calibration->rms_px) words += fmt::format(", {:.3f} px RMS", *rig.calibration->rms_px);
  if (rig.calibration->grade) words += ", " + *rig.calibration->grade;
  row_if_any("calibration", words);
}

void print_tracks(const RecordingSummary& summary) {
  if (summary.tracks.empty()) return;
  const std::int64_t frames = span_of(summary);
  std::size_t width = 5;
  for (const auto& count : summary.tracks) width = std::max(width, std::min<std::size_t>(count.name.label.size(), 32));
  fmt::print("\n  {:>4}  {:<{}}  {:>8}  {:>8}  {:>9}  {:>8}  {:>8}\n", "id", "label", width, "present", "filled", "predicted",
             "first", "last");
  for (const auto& count : summary.tracks) {
    const std::int64_t present = count.samples();
    const std::string first = count.first_index ? fmt::format("{}", *count.first_index) : "-";
    const std::string last = count.last_index ? fmt::format("{}", *count.last_index) : "-";
    fmt::print("  {:>4}  {:<{}}  {:>8}  {:>8}  {:>9}  {:>8}  {:>8}\n", number(count.name.id), count.name.label.substr(0, 32), width,
               percent(present, frames), percent(count.of(Provenance::filled), frames),
               percent(count.of(Provenance::predicted), frames), first, last);
  }
}

void print_motion(const std::string& path, format::motion::MotionFormat format, const format::motion::MotionInfo& info,
                  const RecordingSummary& summary) {
  fmt::print("{}: {}{}\n", path, words_of(format),
             summary.complete ? "" : "; its recording was cut off or still goes on, what follows is what there is");
  row_if_any("name", info.header.name);
  row_if_any("made by", info.header.made_by.program);
  row_if_any("recorded", info.header.recorded_at);
  const std::int64_t frames = span_of(summary);
  const double length_s = summary.first_time ? seconds(*summary.last_time - *summary.first_time) + 1 / info.header.rate_hz : 0;
  row_if_any(
      "length",
      fmt::format("{}: {} frames at {:g} Hz{}", duration_words(length_s), counted(frames), info.header.rate_hz,
                  summary.instants < frames ? fmt::format(", {} of them left out", counted(frames - summary.instants)) : ""));
  if (summary.first_index) row_if_any("frames", fmt::format("{} to {}, counted from 0", *summary.first_index, *summary.last_index));
  const auto labelled =
      std::count_if(summary.tracks.begin(), summary.tracks.end(), [](const auto& count) { return !count.name.label.empty(); });
  row_if_any("tracks", fmt::format("{}, {} with a label", summary.tracks.size(), labelled));
  std::int64_t filled = 0, predicted = 0;
  for (const auto& count : summary.tracks) {
    filled += count.of(Provenance::filled);
    predicted += count.of(Provenance::predicted);
  }
  row_if_any("points", fmt::format("{}: {} measured, {} filled, {} predicted", counted(summary.samples),
                                   percent(summary.samples - filled - predicted, summary.samples), percent(filled, summary.samples),
                                   percent(predicted, summary.samples)));
  if (format == format::motion::MotionFormat::take) row_if_any("observations", counted(summary.seen));
  row_if_any("positions", to_string(info.header.frame));
  if (info.up) row_if_any("up", *info.up == format::motion::UpAxis::y ? "y" : "z");
  for (const Edit& edit : info.edits) row_if_any("edit", fmt::format("{} {}", edit.operation, edit.payload));
  if (info.header.rig) {
    row_if_any("cameras", fmt::format("{}", info.header.rig->cameras.size()));
    print_calibration(*info.header.rig);
    fmt::print("\n");
    print_cameras(*info.header.rig);
  }
  print_tracks(summary);
}

Json as_json(const Rig& rig) {
  Json cameras = Json::array();
  for (const RigCamera& camera : rig.cameras) {
    Json entry{{"name", camera.name}, {"source", camera.source}, {"calibrated", camera.camera().has_value()}};
    if (!camera.detections.empty()) entry["detections"] = camera.detections;
    entry["ground"] = camera.ground_view().has_value();
    if (camera.offset_s) entry["offset_s"] = *camera.offset_s;
    if (camera.size) entry["size"] = {camera.size->width, camera.size->height};
    if (camera.rms_px) entry["rms_px"] = *camera.rms_px;
    cameras.push_back(std::move(entry));
  }
  return cameras;
}

Json as_json(format::motion::MotionFormat format, const format::motion::MotionInfo& info, const RecordingSummary& summary) {
  Json tracks = Json::array();
  for (const auto& count : summary.tracks) {
    Json entry{{"id", number(count.name.id)},
               {"label", count.name.label},
               {"measured", count.of(Provenance::measured)},
               {"filled", count.of(Provenance::filled)},
               {"predicted", count.of(Provenance::predicted)}};
    if (count.first_index && count.last_index) {
      entry["first_frame"] = *count.first_index;
      entry["last_frame"] = *count.last_index;
    }
    tracks.push_back(std::move(entry));
  }
  Json result{{"format", format::motion::motion_format_name(format)},
              {"complete", summary.complete},
              {"name", info.header.name},
              {"made_by", info.header.made_by.program},
              {"rate_hz", info.header.rate_hz},
              {"frames", summary.instants},
              {"points", summary.samples},
              {"observations", summary.seen},
              {"tracks", std::move(tracks)}};
  if (summary.first_index) {
    result["first_frame"] = *summary.first_index;
    result["last_frame"] = *summary.last_index;
    result["duration_s"] = seconds(*summary.last_time - *summary.first_time) + 1 / info.header.rate_hz;
  }
  result["frame"] = to_string(info.header.frame);
  if (!info.header.recorded_at.empty()) result["recorded_at"] = info.header.recorded_at;
  if (info.up) result["up"] = *info.up == format::motion::UpAxis::y ? "y" : "z";
  if (info.header.rig) result["cameras"] = as_json(*info.header.rig);
  Json edits = Json::array();
  for (const Edit& edit : info.edits) edits.push_back({{"id", edit.id}, {"operation", edit.operation}, {"payload", edit.payload}});
  if (!edits.empty()) result["edits"] = std::move(edits);
  return result;
}

void report_motion(const InfoOptions& options, format::motion::MotionFormat format) {
  const auto reader = format::motion::open_motion(options.file, format);
  const RecordingSummary summary =
      format == format::motion::MotionFormat::take ? format::take::TakeReader(options.file).summary() : summary_of(*reader);
  for (const std::string& sentence : reader->warnings()) fmt::print(stderr, "marey: warning: {}\n", sentence);
  if (options.json) {
    print(as_json(format, reader->info(), summary));
  } else if (!options.quiet) {
    print_motion(options.file, format, reader->info(), summary);
  }
}

void report_rig(const InfoOptions& options) {
  const Rig rig = format::rig::read_rig_any(options.file);
  if (options.json) return print({{"format", "rig"}, {"cameras", as_json(rig)}});
  if (options.quiet) return;
  fmt::print("{}: a rig of {} camera{}\n", options.file, rig.cameras.size(), rig.cameras.size() == 1 ? "" : "s");
  print_calibration(rig);
  print_cameras(rig);
}

void run(const InfoOptions& options) {
  const bool folder = std::filesystem::is_directory(options.file);
  const auto format = folder ? std::nullopt : format::motion::motion_format_of_content(options.file);
  if (!folder && format::match::ground_format_of_content(options.file)) {
    report_ground(options.file, options.metadata, options.json, options.quiet);
  } else if (format) {
    report_motion(options, *format);
  } else if (format::rig::rig_format_of_content(options.file)) {
    report_rig(options);
  } else {
    throw Error("{}: is none of the files that Marey knows: points: {}; people on the ground: {}; calibrations: {}", options.file,
                format::motion::motion_format_names(), format::match::ground_format_names(), format::rig::rig_format_names());
  }
}

}  // namespace

void add_info(Command& program) {
  auto options = std::make_shared<InfoOptions>();
  Command command = program.subcommand("info", "Say what is in a file");
  command.input_file("FILE", options->file, "take, C3D, TRC, CSV of points, people on the ground, or calibration").required();
  command.input_file("--metadata", options->metadata, "of TRACAB, EPTS or DFL, where it is not beside FILE under a like name");
  command.reports(options->json, options->quiet, "contents");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
