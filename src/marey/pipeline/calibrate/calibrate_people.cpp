#include "marey/pipeline/calibrate/calibrate_people.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/geometry/lens.h"
#include "marey/pipeline/calibrate/live_blobs.h"
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

/// The rig that was found by videos, its cameras as they were given.
void enter_live_cameras(const Rig& given, const LivePeopleOptions& live, Rig& found) {
  for (std::size_t c = 0; c < given.cameras.size(); ++c) {
    const RigCamera& camera = given.cameras[c];
    found.cameras[c].source = camera.source;
    found.cameras[c].region = camera.region;
    found.cameras[c].offset_s = camera.offset_s;
    found.cameras[c].rate_hz = camera.rate_hz;
  }
  if (live.camera_settings != nullptr) live.camera_settings->enter(found);
}

PeopleCalibration calibrate_live(const Rig& rig, const CalibratePeopleOptions& options, const Hooks& hooks) {
  const RecordedPeople walked = record_people(rig, options.live, hooks);
  CalibratePeopleOptions how = options;
  how.find = [&](const RigCamera& camera, const Hooks& searching) {
    const auto& cameras = walked.rig.cameras;
    const auto c = std::find_if(cameras.begin(), cameras.end(), [&](const RigCamera& other) { return other.name == camera.name; }) -
                   cameras.begin();
    return by_times(options.find(camera, searching), walked.times_s[static_cast<std::size_t>(c)],
                    camera.rate_hz.value_or(kDefaultRate));
  };
  PeopleCalibration result = calibrate_people(walked.rig, how, hooks);
  enter_live_cameras(rig, options.live, result.found.rig);
  result.warnings.insert(result.warnings.begin(), walked.missing.begin(), walked.missing.end());
  return result;
}

constexpr double kShortWalk_s = 10;  // of 1.7 s of a real walk, 4 to 16 % of distances are wrong; of 15 s in simulated rooms 2 %

/// Of the camera that was longest, s.
double duration_of(const marey::calibrate::people::PeopleInput& input) {
  double seconds = 0;
  for (const auto& camera : input.cameras)
    seconds = std::max(seconds, static_cast<double>(camera.sequence.frames.size()) / camera.rate_hz);
  return seconds;
}

}  // namespace

PeopleCalibration calibrate_people(Rig rig, const CalibratePeopleOptions& options, const Hooks& hooks) {
  if (has_live_cameras(rig)) return calibrate_live(rig, options, hooks);
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
  if (const double lasts = duration_of(input); lasts < kShortWalk_s)
    result.warnings.push_back(fmt::format(
        "{:.1f} s are short: distances and focal lengths cannot be separated well then, and lean or stride tilt the world; they "
        "may be off by 10 % and 10°, whatever ± says. Half a minute of one person who walks near and far is what it takes",
        lasts));
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
