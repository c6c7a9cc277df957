// Whether cameras that observe the same ground see the same people there.
//
// A camera whose ground is mirrored, or off by metres, places its people where others see no person. Where two cameras
// both saw people at one time or another, a person seen by the one should be within a metre of a person seen by the other in the
// same instant; how often that happens by chance is reported by the other's people of another time. Cameras that no person crosses
// from one to the other cannot be compared. Cost: for each pair of cameras the people of some hundred instants, twice.
#pragma once

#include <span>
#include <vector>

#include "marey/core/ids.h"
#include "marey/track/ground/camera_bias.h"
#include "marey/track/ground/ground_instant.h"

namespace marey::track::ground {

/// Two cameras that see people on the same part of the ground.
struct ComparedCameras {
  CameraId first{}, second{};
  double agreement = 0;  ///< share of people that the other sees at their place too, beyond chance: 0, as if of other scenes, to 1

  bool contradict() const { return agreement < 0.25; }
};

/// All pairs that can be compared, of recordings of a few seconds at least; `agreement`: the known errors.
std::vector<ComparedCameras> compare_cameras(std::span<const GroundInstant> instants, const CameraBias& agreement, int cameras);

}  // namespace marey::track::ground
