#include "info_ground.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_exchange.h"
#include "marey/format/match/line_ups.h"

#include "json_value.h"

namespace marey::cli {
namespace {

std::string_view words_of(format::match::GroundFormat format) {
  switch (format) {
    case format::match::GroundFormat::csv:
      return "people on the ground, one row each";
    case format::match::GroundFormat::mot:
      return "MOTChallenge text with world coordinates";
    case format::match::GroundFormat::metrica:
      return "a pair of Metrica's CSV files";
    case format::match::GroundFormat::tracab:
      return "a TRACAB file";
    case format::match::GroundFormat::epts:
      return "a FIFA EPTS file";
    case format::match::GroundFormat::soccernet:
      return "a game state of SoccerNet";
    case format::match::GroundFormat::sportec:
      return "positional data of DFL (Sportec)";
    case format::match::GroundFormat::statsperform:
      return "an MA25 file of StatsPerform";
  }
  return {};
}

struct Extent {
  Vector<2> low = Vector<2>::Zero(), high = Vector<2>::Zero();
};

Extent extent_of(const Recording& recording) {
  Extent extent;
  bool any = false;
  for (const TrackColumns& track : recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const Vector<2> place = track.place(row);
      extent.low = any ? Vector<2>(extent.low.cwiseMin(place)) : place;
      extent.high = any ? Vector<2>(extent.high.cwiseMax(place)) : place;
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

Json as_json(const format::match::GroundMatch& match, format::match::GroundFormat format, const Extent& extent) {
  const Recording& recording = match.recording;
  Json people = Json::array(), periods = Json::array();
  for (const std::size_t i : format::match::listed_tracks(match)) {
    const TrackColumns& track = recording.tracks()[i];
    people.push_back(
        {{"id", number(track.id())}, {"label", track.name.label}, {"team", track.name.team}, {"instants", track.size()}});
  }
  for (const format::match::GroundPeriod& period : match.periods)
    periods.push_back({{"period", period.number}, {"first_frame", period.first_frame}, {"last_frame", period.last_frame}});
  Json result{{"format", format::match::ground_format_name(format)},
              {"rate_hz", recording.header.rate_hz},
              {"instants", recording.instants().size()},
              {"places", recording.samples()},
              {"people", people},
              {"periods", periods},
              {"home", match.home},
              {"away", match.away},
              {"pitch", {match.pitch.length, match.pitch.width}},
              {"cameras", cameras_of(recording)}};
  if (recording.samples() > 0) {
    result["first_frame"] = recording.instants().front().index;
    result["last_frame"] = recording.instants().back().index;
    result["x"] = {extent.low.x(), extent.high.x()};
    result["y"] = {extent.low.y(), extent.high.y()};
  }
  return result;
}

void ground_row(const char* name, const std::string& value) {
  fmt::print("  {:<13} {}\n", name, value);
}

void print_table(const std::string& file, const format::match::GroundMatch& match, format::match::GroundFormat format,
                 const Extent& extent) {
  const Recording& recording = match.recording;
  fmt::print("{}: {}\n", file, words_of(format));
  if (recording.samples() == 0) return ground_row("people", "nobody is in it");
  const auto &first = recording.instants().front(), &last = recording.instants().back();
  const double rate_hz = recording.header.rate_hz;
  ground_row("length", fmt::format("{:.2f} s: {} instants, frames {} to {} at {:g} Hz",
                                   seconds(last.time) - seconds(first.time) + 1 / rate_hz, recording.instants().size(), first.index,
                                   last.index, rate_hz));
  for (const format::match::GroundPeriod& period : match.periods)
    ground_row("period", fmt::format("{}: frames {} to {}", period.number, period.first_frame, period.last_frame));
  ground_row("pitch", fmt::format("{:g} x {:g} m", match.pitch.length, match.pitch.width));
  const char* unit = recording.header.frame.metric() ? "m" : "px";
  ground_row("places", fmt::format("{0}, x {2:.2f} to {3:.2f} {1}, y {4:.2f} to {5:.2f} {1}", recording.samples(), unit,
                                   extent.low.x(), extent.high.x(), extent.low.y(), extent.high.y()));
  if (!match.home.empty() || !match.away.empty()) ground_row("teams", fmt::format("{} at home, {}", match.home, match.away));
  fmt::print("\n  {:>6}  {:<24}  {:<24}  {:>9}\n", "id", "label", "team", "instants");
  for (const std::size_t i : format::match::listed_tracks(match)) {
    const TrackColumns& track = recording.tracks()[i];
    fmt::print("  {:>6}  {:<24}  {:<24}  {:>9}\n", number(track.id()), track.name.label, track.name.team, track.size());
  }
}

}  // namespace

void report_ground(const std::string& file, const std::string& metadata, bool json, bool quiet) {
  const auto format = format::match::ground_format_of_content(file);
  if (!format) throw Error("{}: holds no people on the ground; these are read: {}", file, format::match::ground_format_names());
  const format::match::GroundMatch match = format::match::read_ground_as(file, *format, {metadata, {}, 25});
  for (const std::string& sentence : match.warnings) fmt::print(stderr, "marey: warning: {}\n", sentence);
  const Extent extent = extent_of(match.recording);
  if (json) {
    print(as_json(match, *format, extent));
  } else if (!quiet) {
    print_table(file, match, *format, extent);
  }
}

}  // namespace marey::cli
