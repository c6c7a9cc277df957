#include "experiments/hypotheses.h"

#include <array>
#include <chrono>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/evaluate/ground_evaluation.h"

#include "experiments/markdown_table.h"

namespace marey::experiments {
namespace {

constexpr double same_position = 1;  // m

struct Kind {
  const char* name;
  std::optional<simulate::Encounter> encounter;
};
constexpr std::array kKinds{Kind{"cross", simulate::Encounter::cross}, Kind{"side by side", simulate::Encounter::alongside},
                            Kind{"stop", simulate::Encounter::stop}, Kind{"any", std::nullopt}};

struct Association {
  const char* name;
  track::ground::GroundAssociation association;
  bool live;  ///< evaluated is the immediate answer
};
constexpr std::array kAssociations{Association{"gnn", track::ground::GroundAssociation::gnn, false},
                                   Association{"jpda", track::ground::GroundAssociation::jpda, false},
                                   Association{"mht", track::ground::GroundAssociation::mht, false},
                                   Association{"mht, live", track::ground::GroundAssociation::mht, true}};

void add(std::vector<evaluate::TargetPosition>& locations, std::int32_t frame, std::span<const Track<2>> tracks) {
  for (const Track<2>& track : tracks) {
    if (track.confirmed)
      locations.push_back({frame, number(track.id), evaluate::on_ground(track.position), evaluate::on_ground(track.velocity)});
  }
}

std::vector<evaluate::TargetPosition> truth_of(const simulate::EncounterScene& scene) {
  std::vector<evaluate::TargetPosition> locations;
  for (std::size_t frame = 0; frame < scene.truth.size(); ++frame) {
    for (std::size_t i = 0; i < scene.truth[frame].size(); ++i)
      locations.push_back(
          {static_cast<std::int32_t>(frame), static_cast<std::int32_t>(i), evaluate::on_ground(scene.truth[frame][i]), {}});
  }
  return locations;
}

/// A camera high above that sees all of the ground, 10 px a metre.
GroundView view_of(const simulate::EncounterOptions& options) {
  const double margin = 30;
  Matrix<3> ground_from_image;
  ground_from_image << 0.1, 0, -margin, 0, -0.1, options.side + margin, 0, 0, 1;
  const int pixels = static_cast<int>(10 * (options.side + 2 * margin));
  return GroundView(ground_from_image, cv::Size(pixels, pixels));
}

struct Tracked {
  HypothesesExperiment::Score score;
  double seconds = 0;
  std::int64_t steps = 0;
};

Tracked run_tracker(const simulate::EncounterScene& scene, std::span<const evaluate::TargetPosition> truth,
                    const Association& method, track::ground::GroundTrackerOptions options) {
  options.associate = method.association;
  const auto tracker = track::ground::make_ground_tracker(options, ground_views({view_of(scene.options)}));
  std::vector<evaluate::TargetPosition> stated;
  std::int32_t decided = 0;
  Tracked outcome;
  for (std::size_t frame = 0; frame < scene.detected.size(); ++frame) {
    const Timestamp now = timestamp_from_seconds(static_cast<double>(frame) / scene.options.rate_hz);
    const track::ground::CameraObservations inspect{CameraId{0}, now, scene.detected[frame]};
    const auto begin = std::chrono::steady_clock::now();
    const auto tracks = tracker->step(now, {&inspect, 1});
    outcome.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (method.live) {
      add(stated, static_cast<std::int32_t>(frame), tracks);
    } else {
      for (const track::ground::GroundDecision& decision : tracker->decided()) add(stated, decided++, decision.tracks);
    }
  }
  if (!method.live) {
    for (const track::ground::GroundDecision& decision : tracker->decide_all()) add(stated, decided++, decision.tracks);
  }
  outcome.steps = static_cast<std::int64_t>(scene.detected.size());
  const evaluate::Evaluation evaluated = evaluate::evaluate_ground(truth, stated, same_position).scores;
  outcome.score = {evaluated.clear.switches, evaluated.true_boxes, evaluated.clear.misses, evaluated.clear.false_positives, 0};
  return outcome;
}

}  // namespace

HypothesesExperiment run_hypotheses_experiment(const HypothesesExperimentOptions& options, const Hooks& hooks) {
  HypothesesExperiment experiment{.scenes = options.scenes, .seed = options.seed, .kinds = {}, .close_encounters = {}, .rows = {}};
  for (const Kind& kind : kKinds) {
    experiment.kinds.emplace_back(kind.name);
    experiment.close_encounters.push_back(options.scenes * options.encounters.pairs * options.encounters.close_encounters);
  }
  std::vector<std::vector<Tracked>> sums(kAssociations.size(), std::vector<Tracked>(kKinds.size()));
  std::mutex mutex;
  int done = 0;
  const int all = options.scenes * static_cast<int>(kKinds.size());
  tbb::parallel_for(0, all, [&](int index) {
    const std::size_t kind = static_cast<std::size_t>(index) % kKinds.size();
    simulate::EncounterOptions encounters = options.encounters;
    encounters.kind = kKinds[kind].encounter;
    const simulate::EncounterScene scene =
        simulate::simulate_encounters(options.seed + static_cast<std::uint64_t>(index) / kKinds.size(), encounters);
    const std::vector<evaluate::TargetPosition> truth = truth_of(scene);
    for (std::size_t m = 0; m < kAssociations.size(); ++m) {
      const Tracked outcome = run_tracker(scene, truth, kAssociations[m], options.tracker);
      const std::lock_guard lock(mutex);
      Tracked& sum = sums[m][kind];
      sum.score.switches += outcome.score.switches;
      sum.score.people += outcome.score.people;
      sum.score.misses += outcome.score.misses;
      sum.score.untrusted += outcome.score.untrusted;
      sum.seconds += outcome.seconds;
      sum.steps += outcome.steps;
    }
    const std::lock_guard lock(mutex);
    ++done;
    hooks.advance({"scenes", done, all});
  });
  for (std::size_t m = 0; m < kAssociations.size(); ++m) {
    auto& row = experiment.rows.emplace_back();
    row.method = kAssociations[m].name;
    for (Tracked& sum : sums[m]) {
      row.scores.push_back(sum.score);
      if (sum.steps > 0) row.scores.back().step_us = 1e6 * sum.seconds / static_cast<double>(sum.steps);
    }
  }
  return experiment;
}

std::string to_text(const HypothesesExperiment& experiment) {
  std::string text =
      fmt::format("{} scenes of each kind, from seed {}\n\nidentity switches\n{:<12}", experiment.scenes, experiment.seed, "");
  const auto out = std::back_inserter(text);
  const auto columns = [&](const char* last) {
    for (const std::string& kind : experiment.kinds) fmt::format_to(out, "{:>16}", kind);
    fmt::format_to(out, "{}\n", last);
  };
  columns("");
  fmt::format_to(out, "{:<12}", "meetings");
  for (const int close_encounters : experiment.close_encounters) fmt::format_to(out, "{:>16}", close_encounters);
  fmt::format_to(out, "\n");
  const auto& first = experiment.rows.front();
  for (const auto& row : experiment.rows) {
    fmt::format_to(out, "{:<12}", row.method);
    for (std::size_t kind = 0; kind < row.scores.size(); ++kind) {
      const double ratio = static_cast<double>(row.scores[kind].switches) /
                           static_cast<double>(std::max<std::int64_t>(1, first.scores[kind].switches));
      fmt::format_to(out, "{:>16}", fmt::format("{} ({:.2f})", row.scores[kind].switches, ratio));
    }
    fmt::format_to(out, "\n");
  }
  fmt::format_to(out, "in brackets: against {}\n\nmissed / false, % of people and frames\n{:<12}", first.method, "");
  columns("");
  for (const auto& row : experiment.rows) {
    fmt::format_to(out, "{:<12}", row.method);
    for (const auto& score : row.scores) {
      const double percent = 100.0 / static_cast<double>(std::max<std::int64_t>(1, score.people));
      fmt::format_to(out, "{:>16}",
                     fmt::format("{:.2f} / {:.2f}", percent * static_cast<double>(score.misses),
                                 percent * static_cast<double>(score.untrusted)));
    }
    fmt::format_to(out, "\n");
  }
  fmt::format_to(out, "\ntime of a step, µs, mean\n{:<12}", "");
  columns("");
  for (const auto& row : experiment.rows) {
    fmt::format_to(out, "{:<12}", row.method);
    for (const auto& score : row.scores) fmt::format_to(out, "{:>16.1f}", score.step_us);
    fmt::format_to(out, "\n");
  }
  return text;
}

std::string to_markdown(const HypothesesExperiment& experiment) {
  std::vector<std::string> titles{""}, close_encounters{"encounters"};
  for (const std::string& kind : experiment.kinds) titles.push_back(kind);
  for (const int of_kind : experiment.close_encounters) close_encounters.push_back(std::to_string(of_kind));
  std::string text = markdown_header(titles) + markdown_row(close_encounters);
  const auto fraction = [](std::int64_t part, std::int64_t all) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(1, all));
  };
  for (const auto& row : experiment.rows) {
    std::vector<std::string> cells{row.method};
    for (std::size_t kind = 0; kind < row.scores.size(); ++kind) {
      const auto& score = row.scores[kind];
      cells.push_back(fmt::format("{} ({:.2f}); {:.2f} / {:.2f}", score.switches,
                                  fraction(score.switches, experiment.rows.front().scores[kind].switches),
                                  100 * fraction(score.misses, score.people), 100 * fraction(score.untrusted, score.people)));
    }
    text += markdown_row(cells);
  }
  return text;
}

}  // namespace marey::experiments
