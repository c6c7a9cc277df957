#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "marey/core/ground_transform.h"
#include "marey/files/text_safety.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/register.h"

#include "info.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

std::string percent(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? std::string("-") : fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string names_of(const std::vector<Body>& bodies) {
  constexpr std::size_t kNamed = 8;
  std::string names = fmt::format("{}:", bodies.size());
  for (std::size_t i = 0; i < std::min(bodies.size(), kNamed); ++i) names += (i > 0 ? ", " : " ") + bodies[i].label;
  return bodies.size() > kNamed ? names + ", …" : names;
}

/// All frames between the first and the last, those that are omitted too.
std::int64_t span_of(const RecordingSummary& summary) {
  return summary.first_index ? *summary.last_index - *summary.first_index + 1 : 0;
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
  print_row("calibration", words);
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
    fmt::print("  {:>4}  {:<{}}  {:>8}  {:>8}  {:>9}  {:>8}  {:>8}\n", number(count.name.id),
               plain_text(count.name.label.substr(0, 32)), width, percent(present, frames),
               percent(count.of(Provenance::filled), frames), percent(count.of(Provenance::predicted), frames), first, last);
  }
}

struct Extent {
  Vector<2> low = Vector<2>::Zero(), high = Vector<2>::Zero();
};

Extent extent_of(const Recording& recording) {
  Extent extent;
  bool any = false;
  for (const TrackColumns& track : recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const Vector<2> location = track.location(row);
      extent.low = any ? Vector<2>(extent.low.cwiseMin(location)) : location;
      extent.high = any ? Vector<2>(extent.high.cwiseMax(location)) : location;
      any = true;
    }
  }
  return extent;
}

std::vector<std::string> cameras_of(const Recording& recording) {
  std::vector<std::string> names;
  if (!recording.header.rig) return names;
  for (const RigCamera& camera : recording.header.rig->cameras) names.push_back(camera.name);
  return names;
}

/// "theia (20 segments)".
std::string skeletons_of(const std::vector<Body>& bodies) {
  std::map<std::string, int> segments;
  for (const Body& body : bodies) {
    if (!body.skeleton.empty()) ++segments[body.skeleton];
  }
  std::string text;
  for (const auto& [name, count] : segments) text += fmt::format("{}{} ({} segments)", text.empty() ? "" : ", ", name, count);
  return text;
}

}  // namespace

std::string files_that_are_known() {
  using format::Content;
  std::string all;
  for (const Content content : {Content::space, Content::image, Content::ground, Content::rig, Content::observations,
                                Content::detections, Content::labels}) {
    const std::string names = format::names_of_read(content);
    const bool itself = names.find(',') == std::string::npos;
    all += fmt::format("{}{}{}", all.empty() ? "" : "; ", format::words_of(content), itself ? "" : ": " + names);
  }
  return all;
}

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

void print_row(const char* name, const std::string& value) {
  if (!value.empty()) fmt::print("  {:<13} {}\n", name, plain_text(value));
}

void print_warnings(const std::vector<std::string>& warnings) {
  warn(warnings);
}

void print_rig(const Rig& rig) {
  print_calibration(rig);
  print_cameras(rig);
}

void print_recording(const std::string& path, const format::Format& format, const format::FileInfo& info,
                     const RecordingSummary& summary, const std::vector<pipeline::take::EditLine>& edits) {
  fmt::print("{}: {}{}\n", path, format.title,
             summary.complete ? "" : "; its recording was cut off or still continues, what follows is what there is");
  print_row("name", info.header.name);
  print_row("made by", info.header.made_by.program);
  print_row("recorded", info.header.recorded_at);
  const std::int64_t frames = span_of(summary);
  const double length_s = summary.first_time ? seconds(*summary.last_time - *summary.first_time) + 1 / info.header.rate_hz : 0;
  print_row("length",
            fmt::format("{}: {} frames at {:g} Hz{}", duration_words(length_s), counted(frames), info.header.rate_hz,
                        summary.instants < frames ? fmt::format(", {} of them omitted", counted(frames - summary.instants)) : ""));
  if (summary.first_index) print_row("frames", fmt::format("{} to {}, counted from 0", *summary.first_index, *summary.last_index));
  const auto labelled =
      std::count_if(summary.tracks.begin(), summary.tracks.end(), [](const auto& count) { return !count.name.label.empty(); });
  print_row("tracks", fmt::format("{}, {} with a label", summary.tracks.size(), labelled));
  std::int64_t filled = 0, predicted = 0;
  for (const auto& count : summary.tracks) {
    filled += count.of(Provenance::filled);
    predicted += count.of(Provenance::predicted);
  }
  print_row("points", fmt::format("{}: {} measured, {} filled, {} predicted", counted(summary.samples),
                                  percent(summary.samples - filled - predicted, summary.samples), percent(filled, summary.samples),
                                  percent(predicted, summary.samples)));
  if (format.name == "take") print_row("observations", counted(summary.detected));
  if (!info.header.bodies.empty()) print_row("bodies", names_of(info.header.bodies));
  print_row("skeletons", skeletons_of(info.header.bodies));
  if (info.auxiliary.channels > 0) print_row("analog", fmt::format("{} channels", info.auxiliary.channels));
  if (info.auxiliary.events > 0) print_row("events", fmt::format("{}", info.auxiliary.events));
  print_row("positions", to_string(info.header.frame) + (y_grows_down(info.header) ? "; y grows downwards" : ""));
  if (info.header.rig && info.header.time_base.kind != TimeBase::Kind::unspecified)
    print_row("times", to_string(info.header.time_base, *info.header.rig));
  if (info.up) print_row("up", *info.up == format::UpAxis::y ? "y" : "z");
  for (const pipeline::take::EditLine& edit : edits)
    print_row("edit", fmt::format("{} {}{}", edit.id, edit.words, edit.counts ? "" : " (does not count)"));
  if (info.header.rig && !info.header.rig->cameras.empty()) {
    print_row("cameras", fmt::format("{}", info.header.rig->cameras.size()));
    print_calibration(*info.header.rig);
    fmt::print("\n");
    print_cameras(*info.header.rig);
  }
  print_tracks(summary);
}

Json info_json(const Rig& rig) {
  Json cameras = Json::array();
  for (const RigCamera& camera : rig.cameras) {
    Json entry{{"name", camera.name}, {"source", camera.source}, {"calibrated", camera.camera().has_value()}};
    if (!camera.detections.empty()) entry["detections"] = camera.detections;
    entry["ground"] = camera.ground_view(rig.ground).has_value();
    if (camera.offset_s) entry["offset_s"] = *camera.offset_s;
    if (camera.size) entry["size"] = {camera.size->width, camera.size->height};
    if (camera.rms_px) entry["rms_px"] = *camera.rms_px;
    cameras.push_back(std::move(entry));
  }
  return cameras;
}

Json info_json(const format::Format& format, const format::FileInfo& info, const RecordingSummary& summary,
               const std::vector<pipeline::take::EditLine>& edits) {
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
  Json result{{"format", format.name},          {"complete", summary.complete},
              {"name", info.header.name},       {"made_by", info.header.made_by.program},
              {"rate_hz", info.header.rate_hz}, {"frames", summary.instants},
              {"points", summary.samples},      {"observations", summary.detected},
              {"tracks", std::move(tracks)}};
  if (summary.first_index) {
    result["first_frame"] = *summary.first_index;
    result["last_frame"] = *summary.last_index;
    result["duration_s"] = seconds(*summary.last_time - *summary.first_time) + 1 / info.header.rate_hz;
  }
  result["frame"] = to_string(info.header.frame);
  if (info.header.rig && info.header.time_base.kind != TimeBase::Kind::unspecified)
    result["time_base"] = to_string(info.header.time_base, *info.header.rig);
  if (info.header.track_kind != TrackKind::unspecified) result["track_kind"] = to_string(info.header.track_kind);
  for (const Body& body : info.header.bodies)
    result["bodies"].push_back({{"name", body.label}, {"skeleton", body.skeleton}, {"markers", body.markers.size()}});
  if (info.auxiliary.channels > 0) result["analog_channels"] = info.auxiliary.channels;
  if (info.auxiliary.events > 0) result["events"] = info.auxiliary.events;
  if (!info.header.recorded_at.empty()) result["recorded_at"] = info.header.recorded_at;
  if (info.up) result["up"] = *info.up == format::UpAxis::y ? "y" : "z";
  if (info.header.rig && !info.header.rig->cameras.empty()) result["cameras"] = info_json(*info.header.rig);
  if (y_grows_down(info.header)) result["y_down"] = true;
  Json reported = Json::array();
  for (const Edit& edit : info.edits) {
    Json entry{{"id", edit.id}, {"operation", edit.operation}, {"payload", edit.payload}};
    const auto line =
        std::find_if(edits.begin(), edits.end(), [&](const pipeline::take::EditLine& each) { return each.id == edit.id; });
    if (line != edits.end()) entry["description"] = line->words, entry["active"] = line->counts;
    reported.push_back(std::move(entry));
  }
  if (!reported.empty()) result["edits"] = std::move(reported);
  return result;
}

Json info_json(const format::Format& format, const format::match::GroundMatch& match) {
  const Recording& recording = match.recording;
  Json people = Json::array(), periods = Json::array();
  for (const std::size_t i : format::match::listed_tracks(match)) {
    const TrackColumns& track = recording.tracks()[i];
    people.push_back(
        {{"id", number(track.id())}, {"label", track.name.label}, {"team", track.name.team}, {"instants", track.size()}});
  }
  for (const format::match::GroundPeriod& period : match.periods)
    periods.push_back({{"period", period.number}, {"first_frame", period.first_frame}, {"last_frame", period.last_frame}});
  Json result{{"format", format.name},
              {"rate_hz", recording.header.rate_hz},
              {"instants", recording.instants().size()},
              {"places", recording.samples()},
              {"people", people},
              {"periods", periods},
              {"home", match.home},
              {"away", match.away},
              {"pitch", {match.pitch.length, match.pitch.width}},
              {"cameras", cameras_of(recording)}};
  if (y_grows_down(recording.header)) result["y_down"] = true;
  if (recording.samples() > 0) {
    const Extent extent = extent_of(recording);
    result["first_frame"] = recording.instants().front().index;
    result["last_frame"] = recording.instants().back().index;
    result["x"] = {extent.low.x(), extent.high.x()};
    result["y"] = {extent.low.y(), extent.high.y()};
  }
  return result;
}

void print_match(const std::string& path, const format::Format& format, const format::match::GroundMatch& match) {
  const Recording& recording = match.recording;
  fmt::print("{}: {}\n", path, format.title);
  if (recording.samples() == 0) return print_row("people", "no person is in it");
  const auto &first = recording.instants().front(), &last = recording.instants().back();
  const double rate_hz = recording.header.rate_hz;
  print_row("length",
            fmt::format("{:.2f} s: {} instants, frames {} to {} at {:g} Hz", seconds(last.time) - seconds(first.time) + 1 / rate_hz,
                        recording.instants().size(), first.index, last.index, rate_hz));
  for (const format::match::GroundPeriod& period : match.periods)
    print_row("period", fmt::format("{}: frames {} to {}", period.number, period.first_frame, period.last_frame));
  if (recording.header.frame.metric()) print_row("pitch", fmt::format("{:g} x {:g} m", match.pitch.length, match.pitch.width));
  const Extent extent = extent_of(recording);
  const char* unit = recording.header.frame.metric() ? "m" : "px";
  print_row("places", fmt::format("{0}, x {2:.2f} to {3:.2f} {1}, y {4:.2f} to {5:.2f} {1}", recording.samples(), unit,
                                  extent.low.x(), extent.high.x(), extent.low.y(), extent.high.y()));
  if (y_grows_down(recording.header)) print_row("axes", "y grows downwards, seen from above with x to the right");
  if (!match.home.empty() || !match.away.empty()) print_row("teams", fmt::format("{} at home, {}", match.home, match.away));
  fmt::print("\n  {:>6}  {:<24}  {:<24}  {:>9}\n", "id", "label", "team", "instants");
  for (const std::size_t i : format::match::listed_tracks(match)) {
    const TrackColumns& track = recording.tracks()[i];
    fmt::print("  {:>6}  {:<24}  {:<24}  {:>9}\n", number(track.id()), track.name.label, track.name.team, track.size());
  }
}

}  // namespace marey::cli
