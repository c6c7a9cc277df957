#include "marey/pipeline/calibrate/calibrate_people.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/geometry/lens.h"
#include "marey/source/focal_length.h"
#include "marey/source/image_sequence.h"

namespace marey::pipeline::calibrate {
namespace {

bool is_file_of_images(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none) || std::filesystem::is_directory(path, none) ||
         source::is_image_pattern(path);
}

/// What the camera's video or images state of its lens; nothing if they state no focal length, or are not images.
std::optional<double> stated_focal_35mm(const RigCamera& camera) {
  if (camera.lens || !is_file_of_images(camera.source)) return std::nullopt;
  try {
    return source::focal_35mm_of(camera.source);
  } catch (const Error&) {  // not a video: keypoints, which were read already
    return std::nullopt;
  }
}

}  // namespace

PeopleCalibration calibrate_people(Rig rig, const CalibratePeopleOptions& options, const Hooks& hooks) {
  PeopleCalibration result;
  marey::calibrate::people::PeopleInput input;
  auto cameras = keypoints::read_keypoint_cameras(rig, keypoints::Cameras::all, options.set, options.rate_hz, options.find, hooks,
                                                  result.warnings);
  std::vector<std::optional<double>> stated;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    if (!cameras[c])
      throw Error("camera \"{}\" has neither a video nor keypoints: give {}=VIDEO", rig.cameras[c].name, rig.cameras[c].name);
    if (!rig.cameras[c].size) rig.cameras[c].size = cameras[c]->sequence.size;
    std::optional<double> focal_px;
    stated.push_back(stated_focal_35mm(rig.cameras[c]));
    if (stated.back() && rig.cameras[c].size) focal_px = source::focal_px_of(*stated.back(), *rig.cameras[c].size);
    input.cameras.push_back({std::move(cameras[c]->sequence), cameras[c]->rate_hz, focal_px});
  }
  input.rig = std::move(rig);
  result.found = marey::calibrate::people::calibrate_people(input, options.how, hooks);
  for (std::size_t c = 0; c < stated.size(); ++c) {
    const auto& focal_px = input.cameras[c].focal_px;
    if (!focal_px) continue;
    const RigCamera& camera = result.found.rig.cameras[c];
    result.found.notes.push_back(
        fmt::format("camera \"{}\": its file states a focal length of {:.0f} mm (35 mm equivalent), {:.0f} px; found: {:.0f} px",
                    camera.name, *stated[c], *focal_px, geometry::focal_of(*camera.lens).x()));
  }
  return result;
}

}  // namespace marey::pipeline::calibrate
