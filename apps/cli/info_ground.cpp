#include "info_ground.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_exchange.h"

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
  std::int64_t instants = 0;
  std::vector<std::int64_t> seen;  // by person
};

Extent extent_of(const GroundRecording& recording) {
  Extent extent;
  extent.seen.assign(recording.people.size(), 0);
  if (recording.samples.empty()) return extent;
  extent.low = extent.high = recording.samples.front().place;
  std::int64_t last = -1;
  for (const auto& sample : recording.samples) {
    extent.low = extent.low.cwiseMin(sample.place);
    extent.high = extent.high.cwiseMax(sample.place);
    extent.instants += sample.frame != last;
    last = sample.frame;
    ++extent.seen[static_cast<std::size_t>(sample.person)];
  }
  return extent;
}

Json as_json(const format::match::GroundMatch& match, format::match::GroundFormat format, const Extent& extent) {
  const GroundRecording& recording = match.recording;
  Json people = Json::array(), periods = Json::array();
  for (std::size_t i = 0; i < recording.people.size(); ++i) {
    const auto& person = recording.people[i];
    people.push_back({{"id", person.id}, {"label", person.label}, {"team", person.team}, {"instants", extent.seen[i]}});
  }
  for (const format::match::GroundPeriod& period : match.periods)
    periods.push_back({{"period", period.number}, {"first_frame", period.first_frame}, {"last_frame", period.last_frame}});
  Json result{{"format", format::match::ground_format_name(format)},
              {"rate_hz", match.rate_hz},
              {"instants", extent.instants},
              {"places", recording.samples.size()},
              {"people", people},
              {"periods", periods},
              {"home", match.home},
              {"away", match.away},
              {"pitch", {match.pitch.length, match.pitch.width}},
              {"cameras", recording.cameras}};
  if (!recording.samples.empty()) {
    result["first_frame"] = recording.samples.front().frame;
    result["last_frame"] = recording.samples.back().frame;
    result["x"] = {extent.low.x(), extent.high.x()};
    result["y"] = {extent.low.y(), extent.high.y()};
  }
  return result;
}

void row(const char* name, const std::string& value) {
  fmt::print("  {:<13} {}\n", name, value);
}

void print_table(const std::string& file, const format::match::GroundMatch& match, format::match::GroundFormat format,
                 const Extent& extent) {
  const GroundRecording& recording = match.recording;
  fmt::print("{}: {}\n", file, words_of(format));
  if (recording.samples.empty()) return row("people", "nobody is in it");
  const auto &first = recording.samples.front(), &last = recording.samples.back();
  row("length", fmt::format("{:.2f} s: {} instants, frames {} to {} at {:g} Hz", last.time - first.time + 1 / match.rate_hz,
                            extent.instants, first.frame, last.frame, match.rate_hz));
  for (const format::match::GroundPeriod& period : match.periods)
    row("period", fmt::format("{}: frames {} to {}", period.number, period.first_frame, period.last_frame));
  row("pitch", fmt::format("{:g} x {:g} m", match.pitch.length, match.pitch.width));
  row("places", fmt::format("{}, x {:.2f} to {:.2f} m, y {:.2f} to {:.2f} m", recording.samples.size(), extent.low.x(),
                            extent.high.x(), extent.low.y(), extent.high.y()));
  if (!match.home.empty() || !match.away.empty()) row("teams", fmt::format("{} at home, {}", match.home, match.away));
  fmt::print("\n  {:>6}  {:<24}  {:<24}  {:>9}\n", "id", "label", "team", "instants");
  for (std::size_t i = 0; i < recording.people.size(); ++i) {
    const auto& person = recording.people[i];
    fmt::print("  {:>6}  {:<24}  {:<24}  {:>9}\n", person.id, person.label, person.team, extent.seen[i]);
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
