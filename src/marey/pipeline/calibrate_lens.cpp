#include "marey/pipeline/calibrate_lens.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "marey/calibrate/board/choose_views.h"
#include "marey/core/error.h"
#include "marey/pipeline/feed.h"

namespace marey::pipeline {
namespace {

constexpr std::int64_t kFramesLookedAt = 400;  // of a long film: neighbours show the board in nearly the same place

}  // namespace

LensRun calibrate_lens_from(const std::string& input, const calibrate::board::Board& board, const LensRunOptions& options) {
  RigCamera camera;
  camera.source = input;
  camera.region = options.region;
  Feed feed(camera, CameraId{});
  FindBoardsOptions how;
  how.every = std::max<std::int64_t>(1, feed.info().frame_count.value_or(0) / kFramesLookedAt);
  how.progress = options.progress;
  const BoardSightings found = find_boards(feed, calibrate::board::BoardDetector(board), how);
  if (found.sightings.empty())
    throw Error(
        "{}: the board {} is in none of the {} pictures looked at; are its kind, its numbers of {} and its colours as given?",
        input, calibrate::board::to_string(board), found.frames,
        board.kind == calibrate::board::Board::Kind::chess ? "inner corners" : "squares");
  std::vector<calibrate::board::ViewCandidate> candidates;
  for (const BoardSighting& sighting : found.sightings) candidates.push_back({&sighting.view, sighting.sharpness});
  std::vector<calibrate::LensView> views;
  for (const std::size_t i : calibrate::board::choose_views(candidates, found.size, options.most_views))
    views.push_back({fmt::format("frame {}", found.sightings[i].frame), found.sightings[i].view});
  LensRun run;
  run.calibration = calibrate::calibrate_lens(board, found.size, views, options.lens);
  run.frames = found.frames;
  run.sightings = static_cast<int>(found.sightings.size());
  for (const std::string& sentence : found.warnings) {
    if (sentence.find("--rate") == std::string::npos) run.calibration.warnings.push_back(sentence);  // a lens has no rate
  }
  return run;
}

}  // namespace marey::pipeline
