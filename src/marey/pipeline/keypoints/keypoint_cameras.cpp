#include "marey/pipeline/keypoints/keypoint_cameras.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/keypoints/keypoint_file.h"
#include "marey/pipeline/keypoints/keypoint_recording.h"

namespace marey::pipeline::keypoints {
namespace {

namespace fs = std::filesystem;

KeypointSequence sequence_of(const RigCamera& camera, const std::string& path, const std::string& set, const FindInImages& find,
                             const Hooks& hooks) {
  if (format::keypoints::may_hold_keypoints(path)) return format::keypoints::read_keypoints(path, set);
  if (path.ends_with(".marey")) return keypoints_of_take(path);
  std::error_code ignored;
  if (find && camera.detections.empty() && !fs::is_empty(path, ignored)) return find(camera, hooks);
  throw Error("{}: camera \"{}\" needs a video, or keypoints: a folder of OpenPose, a .json or .csv file, or a take", path,
              camera.name);
}

void read_camera(RigCamera& camera, Cameras which, const std::string& set, std::optional<double> rate_hz, const FindInImages& find,
                 const Hooks& hooks, std::optional<KeypointCamera>& into, std::vector<std::string>& warnings, bool& assumed) {
  const std::string path = keypoint_file_of(camera);
  if (path.empty() || (which == Cameras::calibrated && !camera.camera())) return;
  KeypointCamera read{
      .sequence = sequence_of(camera, path, set, find, hooks), .rate_hz = 0, .offset_s = camera.offset_s.value_or(0)};
  if (read.sequence.size) fit_to_size(camera, *read.sequence.size);
  const auto rate = camera.rate_hz ? camera.rate_hz : rate_hz ? rate_hz : read.sequence.rate_hz;
  assumed |= !rate;
  read.rate_hz = rate.value_or(kDefaultRate);
  if (read.sequence.frames.empty()) warnings.push_back(fmt::format("{}: no person is in any frame", path));
  into = std::move(read);
}

[[noreturn]] void refuse_count(std::size_t count, Cameras which) {
  throw Error("there is {} {}camera with a video or keypoints; two are needed: CAMERA=VIDEO, or CAMERA=KEYPOINTS, for each",
              count == 0 ? "no" : "only one", which == Cameras::calibrated ? "calibrated " : "");
}

/// What can be known before minutes of searching. Throws Error if a file is missing, or all but one camera.
void check_files(const Rig& rig, Cameras which, bool one_camera) {
  std::size_t count = 0;
  for (const RigCamera& camera : rig.cameras) {
    const std::string path = keypoint_file_of(camera);
    if (path.empty() || (which == Cameras::calibrated && !camera.camera())) continue;
    ++count;
    std::error_code ignored;
    const bool is_path = path.find_first_of("%*?") == std::string::npos && path.find("://") == std::string::npos;
    if (is_path && !fs::exists(path, ignored)) throw Error("{}: no such file, for camera \"{}\"", plain_text(path), camera.name);
  }
  if (count < 2 && !(one_camera && count == 1)) refuse_count(count, which);
}

/// Throws Error if they cannot be of one recording; warns where frames are missing.
void check_together(const std::vector<const KeypointSequence*>& read, Cameras which, bool one_camera,
                    std::vector<std::string>& warnings) {
  if (read.empty() || (read.size() < 2 && !one_camera)) refuse_count(read.size(), which);
  for (const KeypointSequence* one : read) {
    if (one->set.points != read[0]->set.points)
      throw Error("{}: has the keypoint set {}, and {} has {}; all cameras must have one set", one->from, one->set.name,
                  read[0]->from, read[0]->set.name);
  }
  const auto [minimum, maximum] = std::minmax_element(
      read.begin(), read.end(), [](const auto* a, const auto* b) { return a->frames.size() < b->frames.size(); });
  if ((*minimum)->frames.size() < (*maximum)->frames.size())
    warnings.push_back(fmt::format("{}: has {} frames, and {} has {}; where one camera has none the others continue without it",
                                   (*minimum)->from, (*minimum)->frames.size(), (*maximum)->from, (*maximum)->frames.size()));
}

}  // namespace

std::string keypoint_file_of(const RigCamera& camera) {
  return camera.detections.empty() ? camera.source : camera.detections;
}

std::vector<std::optional<KeypointCamera>> read_keypoint_cameras(Rig& rig, Cameras which, const std::string& set,
                                                                 std::optional<double> rate_hz, const FindInImages& find,
                                                                 const Hooks& hooks, std::vector<std::string>& warnings) {
  std::vector<std::optional<KeypointCamera>> cameras(rig.cameras.size());
  bool assumed = false;
  std::vector<const KeypointSequence*> read;
  const auto calibrated =
      std::count_if(rig.cameras.begin(), rig.cameras.end(), [](const RigCamera& camera) { return camera.camera().has_value(); });
  check_files(rig, which, calibrated == 1);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    read_camera(rig.cameras[c], which, set, rate_hz, find, hooks, cameras[c], warnings, assumed);
    if (cameras[c] && !cameras[c]->sequence.frames.empty()) read.push_back(&cameras[c]->sequence);
  }
  check_together(read, which, calibrated == 1, warnings);
  if (assumed)
    warnings.push_back(
        fmt::format("neither the rig nor the keypoints say how many frames there are in a second: {:g} are assumed; give --rate",
                    kDefaultRate));
  return cameras;
}

}  // namespace marey::pipeline::keypoints
