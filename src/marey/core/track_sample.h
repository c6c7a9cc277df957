#pragma once

#include "marey/core/instant.h"
#include "marey/core/track.h"

namespace marey {

/// What a recording keeps of a track at one instant.
template <int D>
Sample sample_of(const Track<D>& track) {
  Sample sample;
  sample.track = track.id;
  sample.position.template head<D>() = track.position;
  Vector<3> velocity = Vector<3>::Zero();
  velocity.template head<D>() = track.velocity;
  sample.velocity = velocity;
  Matrix<3> covariance = Matrix<3>::Zero();
  covariance.template topLeftCorner<D, D>() = track.covariance;
  sample.covariance = covariance;
  sample.provenance = track.provenance;
  sample.cameras = track.cameras;
  sample.score = track.score;
  sample.box = track.box;
  sample.outline = track.outline;
  return sample;
}

}  // namespace marey
