#include "marey/pipeline/calibrate/calibrate_board.h"

#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/pipeline/calibrate/find_boards.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/source/image_sequence.h"

namespace marey::pipeline::calibrate {
namespace {

bool is_images(const std::string& source) {
  std::error_code error;
  if (std::filesystem::is_directory(source, error)) return true;
  return source::is_image_name(source) || (!std::filesystem::exists(source, error) && source::is_image_pattern(source));
}

/// Whether the sources are images, each of an instant of its own, and no videos.
bool are_stills(const Rig& rig) {
  std::set<bool> kinds;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.source.empty())
      throw Error(
          "camera \"{}\": there is no video or folder of images to search for the board in; name it in the rig or as {}=FILE",
          camera.name, camera.name);
    kinds.insert(is_images(camera.source));
  }
  if (kinds.size() > 1)
    throw Error("some cameras have videos and others images; they cannot be matched in time, so take one kind for all");
  return kinds.contains(true);
}

geometry::Lens lens_by_board(const RigCamera& camera, const marey::calibrate::board::Board& board, const BoardSightings& detected) {
  try {
    return lens_by_sightings(board, detected).lens;
  } catch (const Error& error) {
    throw Error("camera \"{}\" has no lens in the rig, and these images do not specify it: {}", camera.name, error.what());
  }
}

marey::calibrate::board::BoardRigCamera observe_boards(RigCamera& camera, const marey::calibrate::board::BoardDetector& detector,
                                                       const Hooks& hooks) {
  RigCamera by_its_own_clock = camera;
  by_its_own_clock.offset_s.reset();
  corridor::Feed feed(by_its_own_clock, CameraId{});
  const BoardSightings detected = find_boards(feed, detector, {.step = "searching for the board in " + camera.name}, hooks);
  if (detected.sightings.empty()) {
    throw Error("camera \"{}\": the board {} is in none of its {} images: {}", camera.name,
                marey::calibrate::board::to_string(detector.board()), detected.frames, detected.why_missing);
  }
  fit_to_size(camera, detected.size);
  if (!camera.lens) camera.lens = lens_by_board(camera, detector.board(), detected);
  marey::calibrate::board::BoardRigCamera input{camera.name, detected.size, *camera.lens, camera.offset_s.value_or(0), {}};
  for (const BoardSighting& sighting : detected.sightings)
    input.views.push_back({sighting.frame, seconds(sighting.time), sighting.view});
  return input;
}

/// The pose of the first camera where the rig has none: upright at the origin, facing along y.
Rigid3 first_pose() {
  Rigid3 camera_from_world;
  camera_from_world.rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return camera_from_world;
}

void enter(Rig& rig, const marey::calibrate::board::BoardRig& found) {
  const Rigid3 first_from_world = rig.cameras[0].camera_from_world.value_or(first_pose());
  const double first_offset = rig.cameras[0].offset_s.value_or(0);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    RigCamera& camera = rig.cameras[i];
    camera.lens = found.cameras[i].lens;
    camera.camera_from_world = found.cameras[i].camera_from_world * first_from_world;
    camera.offset_s = found.cameras[i].offset_s + first_offset;
    camera.rms_px = found.cameras[i].rms_px;
    camera.ground_from_image.reset();
  }
  rig.calibration = Rig::Calibration{"board", found.mean_px, found.rms_px, found.inliers, found.observations, std::nullopt};
}

}  // namespace

BoardRun calibrate_board(const Rig& rig, const marey::calibrate::board::Board& board, const BoardRunOptions& options,
                         const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  if (rig.cameras.size() < 2) throw Error("a rig is calibrated from two cameras at least, and this one has {}", rig.cameras.size());
  using Timing = marey::calibrate::board::BoardRigOptions::Timing;
  marey::calibrate::board::BoardRigOptions how;
  how.timing = are_stills(rig) ? Timing::stills : options.synced ? Timing::synced : Timing::videos;
  how.refine_lenses = options.refine;
  how.rolling_shutter = options.rolling_shutter;
  how.max_offset_s = options.max_offset_s;
  BoardRun run{rig, {}};
  const marey::calibrate::board::BoardDetector detector(board);
  std::vector<marey::calibrate::board::BoardRigCamera> cameras;
  for (RigCamera& camera : run.rig.cameras) cameras.push_back(observe_boards(camera, detector, hooks));
  for (marey::calibrate::board::BoardRigCamera& camera : cameras) camera.offset_s -= rig.cameras[0].offset_s.value_or(0);
  run.found = marey::calibrate::board::calibrate_board_rig(board, cameras, how);
  enter(run.rig, run.found);
  return run;
}

}  // namespace marey::pipeline::calibrate
