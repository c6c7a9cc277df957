// Markers in space from observations that are in memory: no file is read and none written. A simulated room stands for the cameras.
//   markers_in_memory
#include <cstdio>
#include <memory>
#include <vector>

#include "marey/core/error.h"
#include "marey/reconstruct/correspond.h"
#include "marey/simulate/room/room.h"
#include "marey/track/roster/roster_tracker.h"

int main() try {
  const marey::simulate::room::RoomScene scene({.markers = 20, .frames = 240, .bump = {}});
  std::vector<marey::Camera> cameras;
  for (const marey::RigCamera& camera : scene.rig().cameras) cameras.push_back(*camera.camera());

  marey::reconstruct::Corresponder corresponder(cameras);
  marey::track::roster::RosterTrackerOptions options;
  options.filter = marey::filter::KalmanOptions{.acceleration_noise = 3, .initial_speed = 1.5, .gate_sigmas = 4};
  options.max_speed = 15, options.marker_width = 0.02, options.position_noise = 1e-4;
  const auto tracker = marey::track::roster::make_roster_tracker<3>(options);

  std::size_t located = 0, tracked = 0;
  for (std::int64_t i = 0; i < 240; ++i) {
    const marey::simulate::room::RoomFrame frame = scene.frame(i);
    std::vector<marey::Observation<2>> detected;  // px, of all cameras
    for (std::size_t camera = 0; camera < frame.detected.size(); ++camera) {
      for (const marey::simulate::room::RoomBlob& blob : frame.detected[camera]) {
        marey::Observation<2>& one = detected.emplace_back();
        one.camera = marey::CameraId{static_cast<int>(camera)};
        one.value = blob.pixel;
        one.covariance.reset();  // unknown: the cameras' common noise alone
      }
    }
    std::vector<marey::Observation<3>> points;  // m
    for (const marey::reconstruct::Located& location : corresponder.match(detected).points)
      points.push_back({.value = location.point.position, .covariance = location.point.covariance, .box = {}});
    located += points.size();
    tracked += tracker->step(marey::timestamp_from_seconds(static_cast<double>(i) / 120), points).size();
  }
  std::printf("%.1f points and %.1f tracks in each of 240 instants, of 20 markers\n", static_cast<double>(located) / 240,
              static_cast<double>(tracked) / 240);
  return 0;
} catch (const marey::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
