#include "evaluate_game_state.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/evaluate/game_state_evaluation.h"
#include "marey/format/match/game_state.h"

#include "json_value.h"
#include "run_hooks.h"
#include "scores.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;
using evaluate::GameStateDetail;

constexpr const char* kTruthName = "Labels-GameState.json";
constexpr std::array<const char*, evaluate::game_state_details> kDetails{"places", "roles", "teams", "numbers"};

struct Clip {
  std::string name, truth, tracks;
};

struct EvaluatedClip {
  std::string name;
  evaluate::GameStateEvaluation evaluation;
  std::vector<std::string> warnings = {};
  std::exception_ptr failure = nullptr;
};

EvaluatedClip evaluated(const Clip& clip) {
  const format::match::TrueGameState known = format::match::read_true_game_state(clip.truth);
  const GameState stated = format::match::read_predicted_game_state(clip.tracks, known.images);
  EvaluatedClip result{clip.name, evaluate::evaluate_game_state(known.state.people, stated.people), known.state.warnings};
  result.warnings.insert(result.warnings.end(), stated.warnings.begin(), stated.warnings.end());
  return result;
}

/// All clips, several at a time. Throws what the first that failed threw.
std::vector<EvaluatedClip> evaluated(const std::vector<Clip>& clips) {
  std::vector<EvaluatedClip> results(clips.size());
  tbb::parallel_for(std::size_t{0}, clips.size(), [&](std::size_t i) {
    try {
      results[i] = evaluated(clips[i]);
    } catch (...) {
      results[i].failure = std::current_exception();
    }
  });
  for (const EvaluatedClip& result : results) {
    if (result.failure) std::rethrow_exception(result.failure);
  }
  return results;
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// The folders of `folder` that hold a truth.
std::vector<std::string> clips_of(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (fs::exists(entry.path() / kTruthName, error)) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string predictions_of(const std::string& folder, const std::string& clip) {
  for (const fs::path& path : {fs::path(folder) / (clip + ".json"), fs::path(folder) / "data" / (clip + ".json")}) {
    if (fs::exists(path)) return path.string();
  }
  throw Error("{}: has no {}.json, the predictions of the clip {}", folder, clip, clip);
}

std::vector<Clip> clips_to_evaluate(const std::string& truth, const std::string& tracks) {
  if (!is_folder(truth)) return {{fs::path(tracks).stem().string(), truth, tracks}};
  std::vector<Clip> clips;
  for (const std::string& name : clips_of(truth))
    clips.push_back({name, (fs::path(truth) / name / kTruthName).string(), predictions_of(tracks, name)});
  return clips;
}

Json hota_json(const evaluate::HotaScores& scores) {
  return {{"gs_hota", scores.hota},
          {"deta", scores.detection},
          {"assa", scores.association},
          {"detre", scores.detection_recall},
          {"detpr", scores.detection_precision},
          {"assre", scores.association_recall},
          {"asspr", scores.association_precision},
          {"loca", scores.localisation}};
}

Json result_json(const evaluate::GameStateEvaluation& evaluation) {
  Json json = hota_json(evaluation.gs_hota());
  json["true_people"] = evaluation.true_people;
  json["track_people"] = evaluation.track_people;
  for (std::size_t i = 0; i < kDetails.size(); ++i)
    json["hota_of"][kDetails[i]] = evaluation.scores(static_cast<GameStateDetail>(i)).hota;
  return json;
}

void print_json(const std::vector<EvaluatedClip>& clips, const evaluate::GameStateEvaluation& all,
                const std::vector<std::string>& warnings) {
  Json json = result_json(all);
  json["clips"] = Json::array();
  for (const EvaluatedClip& clip : clips) {
    Json one = result_json(clip.evaluation);
    one["clip"] = clip.name;
    json["clips"].push_back(std::move(one));
  }
  json["warnings"] = warnings;
  print(json);
}

void print_score(const char* name, double value, const char* meaning) {
  fmt::print("  {:<9} {:>9}   {}\n", name, percent(value), meaning);
}

/// The losses by kind.
void print_losses(const evaluate::GameStateEvaluation& all) {
  const auto hota = [&](GameStateDetail detail) { return all.scores(detail).hota; };
  fmt::print("What it would be if less had to be right\n");
  print_score("places", hota(GameStateDetail::positions), "only the places");
  print_score("roles", hota(GameStateDetail::roles), "places and roles (player, goalkeeper, referee, other)");
  print_score("teams", hota(GameStateDetail::teams), "and teams");
  print_score("numbers", hota(GameStateDetail::numbers), "and players' shirt numbers: GS-HOTA");
}

void print_text(const std::vector<EvaluatedClip>& clips, const evaluate::GameStateEvaluation& all) {
  const evaluate::HotaScores scores = all.gs_hota();
  fmt::print("Game state, {} clip{}; truth: {} places of people, predictions: {}.\n\n", clips.size(), clips.size() == 1 ? "" : "s",
             all.true_people, all.track_people);
  print_score("GS-HOTA", scores.hota, "finding and naming, over similarities of 0.05 (5 m) to 0.95 (0.7 m)");
  print_score("DetA", scores.detection, "GS-HOTA's share for finding, with the right role, team and number");
  print_score("DetRe", scores.detection_recall, "of the true places were found so");
  print_score("DetPr", scores.detection_precision, "of the predicted places are right");
  print_score("AssA", scores.association, "GS-HOTA's share for keeping the same track");
  print_score("LocA", scores.localisation, "mean similarity of the matches");
  print_losses(all);
  if (clips.size() < 2) return;
  fmt::print("By clip: GS-HOTA, DetA, AssA\n");
  for (const EvaluatedClip& clip : clips) {
    const evaluate::HotaScores one = clip.evaluation.gs_hota();
    fmt::print("  {:<20} {:>9} {:>9} {:>9}\n", clip.name, percent(one.hota), percent(one.detection), percent(one.association));
  }
}

}  // namespace

bool are_game_states(const std::string& truth, const std::string& tracks) {
  if (is_folder(truth) && is_folder(tracks)) return !clips_of(truth).empty();
  return format::match::is_game_state(truth) && format::match::is_game_state(tracks);
}

void evaluate_game_states(const std::string& truth, const std::string& tracks, bool json, bool quiet) {
  const std::vector<EvaluatedClip> clips = evaluated(clips_to_evaluate(truth, tracks));
  evaluate::GameStateEvaluation all;
  std::vector<std::string> warnings;
  for (const EvaluatedClip& clip : clips) {
    all += clip.evaluation;
    warnings.insert(warnings.end(), clip.warnings.begin(), clip.warnings.end());
  }
  warn(warnings);
  if (json) {
    print_json(clips, all, warnings);
  } else if (!quiet) {
    print_text(clips, all);
  }
}

}  // namespace marey::cli
