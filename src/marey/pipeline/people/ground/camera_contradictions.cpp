#include "marey/pipeline/people/ground/camera_contradictions.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace marey::pipeline::people::ground {
namespace {

using track::ground::ComparedCameras;

const std::string& name_of(const Rig& rig, CameraId camera) {
  return rig.cameras[static_cast<std::size_t>(number(camera))].name;
}

/// Those that contradict all that they were compared with, at least two, some of which agree among themselves.
std::set<CameraId> outvoted(std::span<const ComparedCameras> compared) {
  std::set<CameraId> agreeing, contradicting;
  for (const ComparedCameras& one : compared) {
    if (!one.contradict()) agreeing.insert({one.first, one.second});
  }
  for (const ComparedCameras& one : compared) {
    for (const auto& [camera, other] : {std::pair(one.first, one.second), std::pair(one.second, one.first)}) {
      if (one.contradict() && !agreeing.contains(camera) && agreeing.contains(other)) contradicting.insert(camera);
    }
  }
  return contradicting;
}

}  // namespace

std::vector<std::string> contradicting_cameras(const Rig& rig, std::span<const ComparedCameras> compared) {
  std::vector<std::string> sentences;
  const std::set<CameraId> wrong = outvoted(compared);
  for (const CameraId camera : wrong) {
    sentences.push_back(
        fmt::format("camera \"{}\": its people are not where other cameras that look there see them; its calibration or its "
                    "offset_s is wrong, or its ground is mirrored",
                    name_of(rig, camera)));
  }
  for (const ComparedCameras& one : compared) {
    if (!one.contradict() || wrong.contains(one.first) || wrong.contains(one.second)) continue;
    sentences.push_back(fmt::format(
        "cameras \"{}\" and \"{}\" look at the same ground and do not see the same people there; the calibration or the "
        "offset_s of one is wrong, or its ground is mirrored",
        name_of(rig, one.first), name_of(rig, one.second)));
  }
  return sentences;
}

std::vector<std::string> uncompared_cameras(const Rig& rig, std::span<const ComparedCameras> compared) {
  std::vector<std::string> sentences;
  if (rig.cameras.size() < 2) return sentences;
  std::set<CameraId> known;
  for (const ComparedCameras& one : compared) known.insert({one.first, one.second});
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (known.contains(CameraId{static_cast<int>(i)})) continue;
    sentences.push_back(fmt::format(
        "camera \"{}\" shares too few people with any other camera to be compared with them: whether it agrees is not known",
        rig.cameras[i].name));
  }
  return sentences;
}

}  // namespace marey::pipeline::people::ground
