#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/evaluate/evaluation.h"
#include "marey/evaluate/mask_evaluation.h"
#include "marey/format/tracks/boxes.h"
#include "marey/format/tracks/coco_instances.h"

#include "command_line.h"
#include "commands.h"
#include "evaluate_game_state.h"
#include "evaluate_places.h"
#include "json_value.h"
#include "run_hooks.h"
#include "scores.h"

namespace marey::cli {
namespace {

struct EvaluateOptions {
  std::string truth;
  std::string tracks;
  double iou = 0.5;
  std::optional<double> distance;
  bool motchallenge = false;
  bool json = false;
  bool quiet = false;
};

std::string frames_of(const std::vector<LabelledBox>& boxes) {
  return fmt::format("frames {} to {}", boxes.front().frame + 1, boxes.back().frame + 1);
}

/// What a user should know before believing the figures.
std::vector<std::string> warnings_of(const EvaluateOptions& options, const format::tracks::MotTable& truth,
                                     const format::tracks::MotTable& tracks, const evaluate::Evaluation& result) {
  std::vector<std::string> sentences = truth.warnings;
  sentences.insert(sentences.end(), tracks.warnings.begin(), tracks.warnings.end());
  if (truth.boxes.empty()) sentences.push_back(fmt::format("{}: holds no box that is to be evaluated", options.truth));
  if (tracks.boxes.empty()) sentences.push_back(fmt::format("{}: holds no box", options.tracks));
  if (truth.boxes.empty() || tracks.boxes.empty()) return sentences;
  const bool apart = truth.boxes.back().frame < tracks.boxes.front().frame || tracks.boxes.back().frame < truth.boxes.front().frame;
  if (result.common_frames == 0 || apart) {
    sentences.push_back(fmt::format("truth ({}) and tracks ({}) have no frame in common; do both count frames from 1?",
                                    frames_of(truth.boxes), frames_of(tracks.boxes)));
  } else if (tracks.boxes.back().frame > truth.boxes.back().frame || tracks.boxes.front().frame < truth.boxes.front().frame) {
    sentences.push_back(fmt::format("the tracks ({}) go beyond the truth ({}); what lies beyond counts as false",
                                    frames_of(tracks.boxes), frames_of(truth.boxes)));
  }
  return sentences;
}

Json as_json(const evaluate::Evaluation& result, double iou, const std::vector<std::string>& warnings) {
  Json json = cli::as_json(result);
  json["iou"] = iou;
  json["true_boxes"] = result.true_boxes;
  json["track_boxes"] = result.track_boxes;
  json["warnings"] = warnings;
  return json;
}

std::string verdict(const evaluate::Evaluation& result) {
  if (!result.clear.mota) return "There is no truth, so nothing can be said of the tracks.";
  const double hota = result.hota.hota;
  const char* grade = hota >= 0.75 ? "Excellent" : hota >= 0.6 ? "Good" : hota >= 0.45 ? "Fair" : hota >= 0.3 ? "Poor" : "Bad";
  if (result.track_boxes == 0) return "Bad: there are no tracks, so everything was missed.";
  return fmt::format(
      "{}: {} of what there was to see was found, {} of what was reported is false, and {} of all boxes bear the right name; "
      "names changed {} times on {} objects.",
      grade, percent(result.clear.recall), percent(1 - result.clear.precision.value_or(0)), percent(result.identity.f1),
      result.clear.switches, result.objects);
}

void print_box_row(const char* name, const std::string& value, const char* meaning) {
  fmt::print("  {:<5} {:>9}   {}\n", name, value, meaning);
}

void print_table(const evaluate::Evaluation& result, double iou) {
  const evaluate::ClearScores& clear = result.clear;
  fmt::print("{} frames; truth: {} objects, {} boxes; tracks: {}, {} boxes. A box counts as found from an overlap (IoU) of {}.\n\n",
             result.frames, result.objects, result.true_boxes, result.tracks, result.track_boxes, iou);
  fmt::print("Overall\n");
  print_box_row("MOTA", percent(clear.mota), "1 - (FP + FN + IDSW) / true boxes; 100 % is perfect, below 0 is possible");
  print_box_row("IDF1", percent(result.identity.f1), "boxes that bear the right name throughout, of both files' boxes");
  print_box_row("HOTA", percent(result.hota.hota), "finding and naming weighed alike, over overlaps of 0.05 to 0.95");
  fmt::print("Finding\n");
  print_box_row("FP", fmt::format("{}", clear.false_positives), "reported boxes where nothing is");
  print_box_row("FN", fmt::format("{}", clear.misses), "true boxes that were missed");
  print_box_row("DetA", percent(result.hota.detection), "HOTA's share for finding");
  fmt::print("Naming\n");
  print_box_row("IDSW", fmt::format("{}", clear.switches), "times an object's track became another one");
  print_box_row("FRAG", fmt::format("{}", clear.fragmentations), "times an object was lost and found again");
  print_box_row("IDP", percent(result.identity.precision), "of the reported boxes bear the right name");
  print_box_row("IDR", percent(result.identity.recall), "of the true boxes bear the right name");
  print_box_row("AssA", percent(result.hota.association), "HOTA's share for naming");
  fmt::print("Placing\n");
  print_box_row("MOTP", clear.motp ? fmt::format("{:.3f}", *clear.motp) : "none",
                "mean distance 1 - IoU of the boxes found; 0 is perfect");
  print_box_row("LocA", percent(result.hota.localisation), "mean overlap of HOTA's matches");
  fmt::print("Objects\n");
  print_box_row("MT", fmt::format("{}", clear.mostly_tracked), "mostly tracked: found in 80 % of their frames or more");
  print_box_row("PT", fmt::format("{}", clear.partially_tracked), "partially tracked");
  print_box_row("ML", fmt::format("{}", clear.mostly_lost), "mostly lost: found in less than 20 %");
  fmt::print("\n{}\n", verdict(result));
}

std::string figure(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "none";
}

/// Masks of one image size.
void check_sizes(const EvaluateOptions& options, const format::tracks::MaskTable& truth, const format::tracks::MaskTable& tracks) {
  const RunMask* first = nullptr;
  for (const auto* masks : {&truth.masks, &truth.ignored, &tracks.masks}) {
    for (const LabelledMask& one : *masks) {
      if (first == nullptr) first = &one.mask;
      if (one.mask.width == first->width && one.mask.height == first->height) continue;
      throw Error("{} and {}: masks of images of {} x {} and of {} x {} px; expected one size", options.truth, options.tracks,
                  first->width, first->height, one.mask.width, one.mask.height);
    }
  }
}

void evaluate_mask_files(const EvaluateOptions& options) {
  const format::tracks::MaskTable truth = format::tracks::read_masks(options.truth);
  format::tracks::MaskTable tracks = format::tracks::read_masks(options.tracks);
  check_sizes(options, truth, tracks);
  evaluate::remove_ignored(truth.masks, truth.ignored, options.iou, tracks.masks);
  const evaluate::MaskEvaluation result = evaluate::evaluate_masks(truth.masks, tracks.masks, options.iou);
  std::vector<std::string> warnings = truth.warnings;
  warnings.insert(warnings.end(), tracks.warnings.begin(), tracks.warnings.end());
  if (truth.masks.empty()) warnings.push_back(fmt::format("{}: contains no mask that is evaluated", options.truth));
  if (tracks.masks.empty()) warnings.push_back(fmt::format("{}: contains no mask", options.tracks));
  warn(warnings);
  if (options.json) {
    Json json = cli::as_json(result.scores);
    json["iou"] = options.iou;
    json["true_masks"] = result.scores.true_boxes;
    json["track_masks"] = result.scores.track_boxes;
    json["smotsa"] = or_null(result.smotsa);
    json["motsp"] = or_null(result.motsp);
    json["warnings"] = warnings;
    print(json);
  } else if (!options.quiet) {
    fmt::print("Masks\n");
    print_box_row("sMOTSA", percent(result.smotsa), "(sum of the overlaps - FP - IDSW) / true masks");
    print_box_row("MOTSP", figure(result.motsp), "mean overlap (IoU) of the masks found; 1 is perfect");
    print_table(result.scores, options.iou);
  }
}

void run(const EvaluateOptions& options) {
  if (options.truth == "-" && options.tracks == "-") throw WrongUsage("only one of --truth and --tracks can be standard input");
  if (!options.distance && are_game_states(options.truth, options.tracks))
    return evaluate_game_states(options.truth, options.tracks, options.json, options.quiet);
  if (!options.distance && format::tracks::has_masks(options.truth) && format::tracks::has_masks(options.tracks)) {
    return evaluate_mask_files(options);
  }
  if (options.distance) return evaluate_positions(options.truth, options.tracks, *options.distance, options.json, options.quiet);
  format::tracks::MotTable truth = format::tracks::read_boxes(options.truth, format::tracks::MotKind::truth);
  if (options.motchallenge) std::erase_if(truth.boxes, [](const LabelledBox& box) { return box.score == 0; });
  const format::tracks::MotTable tracks = format::tracks::read_boxes(options.tracks, format::tracks::MotKind::tracks);
  const evaluate::Evaluation result = evaluate::evaluate(truth.boxes, tracks.boxes, options.iou);
  const std::vector<std::string> warnings = warnings_of(options, truth, tracks, result);
  warn(warnings);
  if (options.json) {
    print(as_json(result, options.iou, warnings));
  } else if (!options.quiet) {
    print_table(result, options.iou);
  }
}

}  // namespace

void add_evaluate(Command& program) {
  auto options = std::make_shared<EvaluateOptions>();
  Command command = program.subcommand("evaluate", "Evaluate tracks against the truth");
  command
      .input_file(
          "--truth", options->truth,
          "the truth: MOTChallenge text, or any file of tracks in an image (with --distance, of people on the ground or of "
          "markers in space), or masks (MOTS text, COCO instances: then masks are evaluated), or a game state of SoccerNet or a "
          "folder of them (then GS-HOTA); - for standard input")
      .required();
  command.input_file("--tracks", options->tracks, "the tracks to evaluate, likewise; - for standard input").required();
  const Option iou = command.number("--iou", options->iou, "IoU", above(0, 1),
                                    "overlap (intersection over union) from which a box counts as found");
  const Option motchallenge =
      command.flag("--motchallenge", options->motchallenge,
                   "do not evaluate lines of the truth whose seventh column is 0, as MOTChallenge marks them");
  command
      .number("--distance", options->distance, "m", closed(1e-6, 1e3),
              "evaluate people on the ground, or markers in space: from how near one counts as found")
      .excludes(iou)
      .excludes(motchallenge);
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
