#include "marey/pipeline/calibrate_wand.h"

#include <utility>

#include "marey/pipeline/camera_blobs.h"

namespace marey::pipeline {

WandCalibration calibrate_wand(const Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  calibrate::wand::WandInput input{.rig = rig, .wand = options.wand, .seen = {}};
  CameraBlobs blobs = blobs_of(input.rig, options.observations, options.markers, hooks);
  input.seen = std::move(blobs.seen);
  calibrate::wand::WandOptions how = options.how;
  how.find_offsets = blobs.timed && !options.synced;
  return {calibrate::wand::calibrate_wand(input, how, hooks), std::move(blobs.warnings)};
}

}  // namespace marey::pipeline
