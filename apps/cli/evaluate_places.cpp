#include "evaluate_places.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/pipeline/take/evaluate_match.h"

#include "command_line.h"
#include "json_value.h"
#include "run_hooks.h"
#include "scores.h"

namespace marey::cli {
namespace {

void add_spread(Json& json, const char* name, const char* unit, const std::optional<evaluate::ErrorSpread>& spread) {
  const auto key = [&](const char* which) { return fmt::format("{}_{}_{}", name, which, unit); };
  json[key("rms")] = spread ? Json(spread->rms) : Json();
  json[key("median")] = spread ? Json(spread->median) : Json();
  json[key("p95")] = spread ? Json(spread->p95) : Json();
}

std::optional<double> fraction_kept(const std::vector<evaluate::TargetFate>& people) {
  if (people.empty()) return std::nullopt;
  const auto kept = std::count_if(people.begin(), people.end(), [](const evaluate::TargetFate& person) { return person.kept(); });
  return static_cast<double>(kept) / static_cast<double>(people.size());
}

/// Of the reported places, those where no person is.
std::optional<double> fraction_false(const evaluate::ClearScores& clear) {
  if (!clear.precision) return std::nullopt;
  return 1 - *clear.precision;
}

Json people_json(const pipeline::take::MatchEvaluation& judgement) {
  std::map<int, pipeline::take::PathLengths> lengths;
  for (const pipeline::take::PathLengths& one : judgement.path_lengths) lengths[one.id] = one;
  Json people = Json::array();
  for (const evaluate::TargetFate& person : judgement.evaluation.people) {
    Json entry{{"id", person.id},
               {"track", nullptr},
               {"frames", person.frames},
               {"found", person.found},
               {"own", person.agreeing},
               {"switches", person.switches},
               {"tracked_fraction", person.kept()}};
    if (person.track) entry["track"] = *person.track;
    if (const auto one = lengths.find(person.id); one != lengths.end()) {
      entry["true_distance_m"] = one->second.true_m;
      entry["track_distance_m"] = one->second.track_m;
    }
    people.push_back(std::move(entry));
  }
  return people;
}

Json as_json(const pipeline::take::MatchEvaluation& judgement, double distance, const std::vector<std::string>& warnings) {
  const evaluate::Evaluation& scores = judgement.evaluation.scores;
  Json json = cli::as_json(scores);
  json["distance"] = distance;
  json["paired_by"] = judgement.by_time ? "time" : "frame";
  json["true_places"] = scores.true_boxes;
  json["track_places"] = scores.track_boxes;
  json["found"] = or_null(scores.clear.recall);
  json["false"] = or_null(fraction_false(scores.clear));
  json["tracked_fraction"] = or_null(fraction_kept(judgement.evaluation.people));
  json["distance_error"] = or_null(judgement.distance_error);
  json["people"] = people_json(judgement);
  json["warnings"] = warnings;
  add_spread(json, "position", "m", judgement.evaluation.position);
  const bool speed = judgement.has_speed;
  add_spread(json, "speed", "mps", speed ? judgement.evaluation.speed : std::nullopt);
  add_spread(json, "velocity", "mps", speed ? judgement.evaluation.velocity : std::nullopt);
  return json;
}

void print_ground_row(const char* name, const std::string& value, const char* meaning) {
  fmt::print("  {:<9} {:>24}   {}\n", name, value, meaning);
}

std::string words_of(const std::optional<evaluate::ErrorSpread>& spread, int digits = 3) {
  return spread ? fmt::format("{0:.{3}f} / {1:.{3}f} / {2:.{3}f}", spread->rms, spread->median, spread->p95, digits) : "none";
}

void print_table(const pipeline::take::MatchEvaluation& judgement, double distance, bool in_space) {
  const evaluate::Evaluation& scores = judgement.evaluation.scores;
  const evaluate::ClearScores& clear = scores.clear;
  fmt::print("{} instants; truth: {} {}, {} places; tracks: {}, {} places. {} counts as found within {} m.\n\n", scores.frames,
             scores.objects, in_space ? "markers" : "people", scores.true_boxes, scores.tracks, scores.track_boxes,
             in_space ? "A marker" : "Someone", distance);
  fmt::print("Finding\n");
  print_ground_row("found", percent(clear.recall), fmt::format("of the true places; {} missed", clear.misses).c_str());
  print_ground_row("false", percent(fraction_false(clear)),
                   fmt::format("of the reported places: {} where no person is", clear.false_positives).c_str());
  print_ground_row("MOTA", percent(clear.mota), "1 - (FP + FN + IDSW) / true places");
  fmt::print("Naming\n");
  print_ground_row("kept", percent(fraction_kept(judgement.evaluation.people)),
                   in_space ? "of the markers: one track in 80 % of their instants and no switch"
                            : "of the people: one track in 80 % of their instants and no switch");
  print_ground_row("IDSW", fmt::format("{}", clear.switches),
                   in_space ? "times a marker's track became another one" : "times a person's track became another one");
  print_ground_row("IDF1", percent(scores.identity.f1), "places that bear the right name throughout, of both files' places");
  print_ground_row("IDP, IDR", percent(scores.identity.precision) + ", " + percent(scores.identity.recall),
                   "the same, of the reported places and of the true ones");
  print_ground_row("HOTA", percent(scores.hota.hota), "finding and naming weighed alike");
  fmt::print("Measuring: root mean square / median / 95 % of the errors\n");
  print_ground_row("position", words_of(judgement.evaluation.position, in_space ? 6 : 3), "m");
  print_ground_row("speed", judgement.has_speed ? words_of(judgement.evaluation.speed) : "none", "m/s");
  print_ground_row("velocity", judgement.has_speed ? words_of(judgement.evaluation.velocity) : "none", "m/s, its direction too");
  if (in_space) return;
  print_ground_row("distance", percent(judgement.distance_error),
                   "by which the ways that people ran come out wrong, of their length");
}

/// What a user should know before believing the figures.
std::vector<std::string> warnings_of(const std::string& truth_name, const std::string& tracks_name, const Recording& truth,
                                     const Recording& tracks, const pipeline::take::MatchEvaluation& judgement) {
  std::vector<std::string> sentences = judgement.warnings;
  const bool truth_is_empty = truth.samples() == 0, tracks_are_empty = tracks.samples() == 0;
  if (truth_is_empty) sentences.push_back(fmt::format("{}: no person is in it", truth_name));
  if (tracks_are_empty) sentences.push_back(fmt::format("{}: no person is in it", tracks_name));
  if (truth_is_empty || tracks_are_empty) return sentences;
  if (judgement.evaluation.scores.common_frames == 0) sentences.push_back("truth and tracks have no instant in common");
  const double true_first = truth.seconds_at(0), true_last = truth.seconds_at(truth.instants().size() - 1);
  const double first = tracks.seconds_at(0), last = tracks.seconds_at(tracks.instants().size() - 1);
  constexpr double much = 0.5;
  if (true_first - first > much || last - true_last > much)
    sentences.push_back(fmt::format("the tracks ({:.2f} to {:.2f} s) go beyond the truth ({:.2f} to {:.2f} s)", first, last,
                                    true_first, true_last));
  return sentences;
}

/// People on the ground, or markers in space, whatever the file.
Recording positions_in(const std::string& path, const format::ReadOptions& options = {}) {
  const format::Format* format = path == "-" ? nullptr : format::format_of_content(path);
  const bool may_be_space = format != nullptr && format->holds.has(format::Content::space);
  if (!may_be_space || format::content_of(format::open_recording(path, *format, options)->header().frame) != format::Content::space)
    return format::read_match(path, options).recording;
  return format::read_whole(path, *format, options).recording;
}

}  // namespace

void evaluate_positions(const std::string& truth_name, const std::string& tracks_name, double distance, bool json, bool quiet) {
  const Recording tracks = positions_in(tracks_name);
  // A truth that has frames and no times has the tracks'.
  format::ReadOptions as_tracks;
  as_tracks.rate_hz = tracks.header.rate_hz;
  const Recording truth = positions_in(truth_name, as_tracks);
  const pipeline::take::MatchEvaluation judgement = pipeline::take::evaluate_match(truth, tracks, distance);
  const std::vector<std::string> warnings = warnings_of(truth_name, tracks_name, truth, tracks, judgement);
  warn(warnings);
  if (json) {
    print(as_json(judgement, distance, warnings));
  } else if (!quiet) {
    print_table(judgement, distance, tracks.header.frame.dimensions() == 3);
  }
}

}  // namespace marey::cli
