#include "marey/pipeline/calibrate/calibrate_ground.h"

#include "marey/calibrate/board/board_detector.h"
#include "marey/calibrate/board/board_pose.h"
#include "marey/core/error.h"
#include "marey/pipeline/calibrate/camera_blobs.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {
namespace {

constexpr int kMaxImages = 50;  // of a source that are searched for the board

std::optional<Rigid3> camera_from_board(const RigCamera& camera, const marey::calibrate::board::Board& board, const Hooks& hooks) {
  corridor::Feed feed(camera, CameraId{}, {.ahead = 0});
  const marey::calibrate::board::BoardDetector detector(board);
  for (int i = 0; i < kMaxImages; ++i) {
    hooks.advance({"searching for the board", i, std::nullopt});
    const auto given = feed.next();
    if (!given) break;
    const auto view = detector.detect(given->frame.image);
    if (!view) continue;
    if (const auto pose = marey::calibrate::board::board_pose(board, *view, *feed.camera().lens)) return pose;
  }
  return std::nullopt;
}

marey::calibrate::GroundFound ground_by_board(const Rig& rig, const marey::calibrate::board::Board& board, const Hooks& hooks) {
  std::vector<Rigid3> found;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.source.empty() || !camera.camera()) continue;
    const auto pose = camera_from_board(camera, board, hooks);
    if (pose) found.push_back(camera.camera_from_world->inverse() * *pose);
  }
  if (found.empty())
    throw Error("{}", "no camera that has a source, a lens and a pose sees the board: lay it where one does, and check --board");
  return marey::calibrate::ground_under_board(found);
}

marey::calibrate::GroundFound ground_by_frame(Rig& rig, const CalibrateGroundOptions& options, const Hooks& hooks,
                                              std::vector<std::string>& warnings) {
  CameraBlobs blobs = blobs_of(rig, options.observations, options.markers, hooks);
  warnings = std::move(blobs.warnings);
  std::vector<std::vector<Vector<2>>> still;
  for (const auto& frames : blobs.detected) still.push_back(marey::calibrate::still_blobs(frames));
  return marey::calibrate::find_ground(rig, still, options.frame, options.scale);
}

}  // namespace

GroundCalibration calibrate_ground(const Rig& rig, const CalibrateGroundOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  GroundCalibration result{rig, {}, {}};
  result.found =
      options.board ? ground_by_board(rig, *options.board, hooks) : ground_by_frame(result.rig, options, hooks, result.warnings);
  result.rig = marey::calibrate::moved_to_ground(result.rig, result.found.ground_from_world, result.found.scale);
  return result;
}

}  // namespace marey::pipeline::calibrate
