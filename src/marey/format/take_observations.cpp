#include "marey/format/take_observations.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"

namespace marey::format {
namespace {

CameraId camera_of_name(const std::string& name, const Rig& rig, const std::string& path) {
  const auto same = [&](const RigCamera& camera) { return camera.name == name; };
  const auto found = std::find_if(rig.cameras.begin(), rig.cameras.end(), same);
  if (found == rig.cameras.end())
    throw Error("{}: what its camera \"{}\" saw has no place in the rig, which has {}; name the cameras alike", path, name,
                camera_names(rig));
  return CameraId{static_cast<int>(found - rig.cameras.begin())};
}

}  // namespace

TakeObservations::TakeObservations(const std::string& path, const Rig& rig) : reader_(path) {
  const Rig own = rig_of_take(path);
  if (reader_.summary().detected == 0)
    throw Error("{}: holds nothing that cameras saw, so it cannot be solved again; a take of marey reconstruct does", path);
  for (const RigCamera& camera : own.cameras) cameras_.push_back(camera_of_name(camera.name, rig, path));
}

std::optional<ObservedFrame> TakeObservations::next() {
  const auto instant = reader_.next();
  if (!instant) return std::nullopt;
  ObservedFrame frame{.frame = instant->index, .time = instant->time};
  for (const marey::ImageObservation& detected : instant->detected) {
    const auto camera = static_cast<std::size_t>(number(detected.camera));
    if (camera >= cameras_.size()) continue;
    frame.points.push_back({.camera = cameras_[camera], .pixel = detected.pixel, .sigma = detected.sigma, .area = detected.area});
  }
  std::stable_sort(frame.points.begin(), frame.points.end(),
                   [](const ImageObservation& a, const ImageObservation& b) { return a.camera < b.camera; });
  return frame;
}

Rig rig_of_take(const std::string& path) {
  const take::TakeReader reader(path, {.detected = false});
  if (!reader.header().rig) throw Error("{}: this take does not specify which cameras recorded it; give a rig file", path);
  return *reader.header().rig;
}

}  // namespace marey::format
