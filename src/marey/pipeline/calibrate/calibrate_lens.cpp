#include "marey/pipeline/calibrate/calibrate_lens.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {
namespace {

constexpr std::int64_t kFramesInspectedAt = 400;  // of a long video: neighbours show the board in nearly the same place

}  // namespace

LensRun calibrate_lens(const std::string& input, const marey::calibrate::board::Board& board, const LensRunOptions& options,
                       const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  RigCamera camera;
  camera.source = input;
  camera.region = options.region;
  corridor::Feed feed(camera, CameraId{});
  FindBoardsOptions how;
  how.every = std::max<std::int64_t>(1, feed.info().frame_count.value_or(0) / kFramesInspectedAt);
  const BoardSightings found = find_boards(feed, marey::calibrate::board::BoardDetector(board), how, hooks);
  if (found.sightings.empty())
    throw Error("{}: the board {} is in none of the {} images searched: {}", input, marey::calibrate::board::to_string(board),
                found.frames, found.why_missing);
  LensRun run;
  run.calibration = lens_by_sightings(board, found, options.max_views, options.lens);
  run.frames = found.frames;
  run.sightings = static_cast<int>(found.sightings.size());
  for (const std::string& message_text : found.warnings) {
    if (message_text.find("--rate") == std::string::npos) run.calibration.warnings.push_back(message_text);  // a lens has no rate
  }
  return run;
}

}  // namespace marey::pipeline::calibrate
