#pragma once

#include <optional>

#include "marey/core/appearance.h"
#include "marey/core/detection.h"
#include "marey/core/geometry.h"
#include "marey/core/ids.h"

namespace marey {

/// What a tracker is fed: a measured place. px in the image, m on the ground and in space.
template <int D>
struct Observation {
  Vector<D> value = Vector<D>::Zero();
  std::optional<Matrix<D>> covariance = Matrix<D>::Identity();  ///< of `value`; nothing if unknown, which trackers refuse
  CameraId camera{};
  double score = 1;        ///< in [0, 1]; a weak one may continue a track, not begin one
  std::optional<Box> box;  ///< px, where the thing has an extent in the image
  bool shared = false;     ///< part of a region that several targets share: its place is trusted, its size is not
  std::optional<Appearance> appearance = {};  ///< clothing colours, if images show them
};

/// What a detection of a small thing, a marker, is to a tracker: its centre.
inline Observation<2> observation_of(const Detection& detection) {
  Observation<2> observation;
  observation.value = detection.centre;
  observation.covariance = detection.covariance;
  observation.score = detection.score;
  observation.box = detection.box;
  return observation;
}

}  // namespace marey
