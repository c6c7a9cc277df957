#pragma once

#include <memory>
#include <optional>
#include <string>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/outline.h"
#include "marey/core/provenance.h"

namespace marey {

/// One target at one instant, as a tracker reports it. px and px/s in the image, m and m/s on the ground and in space.
template <int D>
struct Track {
  TrackId id{};
  std::string label;  ///< empty if none was given
  Vector<D> position = Vector<D>::Zero();
  Vector<D> velocity = Vector<D>::Zero();
  Matrix<D> covariance = Matrix<D>::Identity();  ///< of `position`
  Provenance provenance = Provenance::measured;
  std::optional<int> observation;  ///< index of what it was given of this instant's observations; nothing if it is predicted
  bool confirmed = true;           ///< false while evidence is still gathered that there is a target at all
  std::optional<Box> box;          ///< px, where the target has an extent in the image
  double score = 1;                ///< of the observation behind it, in [0, 1]
  CameraMask cameras = 0;          ///< the ones that saw it at this instant, if several cameras face one ground
  std::optional<Appearance> appearance = {};         ///< at this instant, of its visible part
  std::shared_ptr<const Outline> outline = nullptr;  ///< in the image, where outlines are followed and this one has one

  bool measured() const { return provenance == Provenance::measured; }
};

}  // namespace marey
