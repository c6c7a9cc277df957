// Parts of foot_forces: a plate's loads as force and centre of pressure, its contacts, and how it is oriented.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/gait/foot_forces.h"

namespace marey::analyse::gait {

/// The feet's paths with their time.
struct FeetOnGround {
  const FeetPaths& feet;
  double rate_hz = 0;
  double begin_s = 0;  ///< of the first row

  /// Heel and toe at a time of the recording; nothing if one of them is missing there.
  std::optional<std::pair<Vector<3>, Vector<3>>> at(Side side, double time_s) const;
  /// How far a point on the ground is from the line from heel to toe, seen from above.
  std::optional<double> distance(Side side, double time_s, const Vector<3>& point) const;
};

/// Nothing if the force is 5 N upwards or less, or the plate is saturated. With no contact's threshold applied.
std::optional<FootLoad> foot_load(const ForcePlate& plate, std::size_t sample);

/// With the foot found. `index` is the plate's.
std::vector<PlateContact> contacts_of(const ForcePlate& plate, std::size_t index, const FeetOnGround& ground,
                                      const FootForceOptions& options);

/// Turns a plate whose forces pull, or whose corners are in another order than C3D has them. Says so.
std::optional<std::string> orient(ForcePlate& plate, const FeetOnGround& ground, const FootForceOptions& options);

}  // namespace marey::analyse::gait
