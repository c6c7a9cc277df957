#include "marey/pipeline/calibrate/calibrate_people.h"

#include <utility>

#include "marey/core/error.h"

namespace marey::pipeline::calibrate {

PeopleCalibration calibrate_people(Rig rig, const CalibratePeopleOptions& options, const Hooks& hooks) {
  PeopleCalibration result;
  marey::calibrate::people::PeopleInput input;
  auto cameras = keypoints::read_keypoint_cameras(rig, keypoints::Cameras::all, options.set, options.rate_hz, options.find, hooks,
                                                  result.warnings);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    if (!cameras[c])
      throw Error("camera \"{}\" has neither a video nor keypoints: give {}=VIDEO", rig.cameras[c].name, rig.cameras[c].name);
    if (!rig.cameras[c].size) rig.cameras[c].size = cameras[c]->sequence.size;
    input.cameras.push_back({std::move(cameras[c]->sequence), cameras[c]->rate_hz});
  }
  input.rig = std::move(rig);
  result.found = marey::calibrate::people::calibrate_people(input, options.how, hooks);
  return result;
}

}  // namespace marey::pipeline::calibrate
