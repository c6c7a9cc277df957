// What feet do to force plates: which foot stands on which plate when, and the ground's force, centre of pressure and free moment
// on each foot.
//
// A plate's channels are brought to zero where nothing is on it: quiet spans near zero, with a straight line between them, so that
// a drift goes too. A contact is a span with more than 20 N upwards. Its foot is the one whose line from heel to toe the centre of
// pressure follows; where the other foot stands on the same plate, or a foot reaches over the edge, the contact belongs to no foot
// and the reason is kept. A plate whose forces pull instead of push, or whose centre of pressure is nowhere near a foot and is near
// one if its corners are read in another order, is turned, and reported.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/analyse/gait/gait_events.h"
#include "marey/core/force_plate.h"

namespace marey::analyse::gait {

struct FootForceOptions {
  double threshold_n = 20;           ///< a foot is on the plate above it
  double min_contact_s = 0.05;       ///< shorter ones are not steps
  double max_foot_distance_m = 0.1;  ///< between the centre of pressure and the foot's line, on the mean of a contact
};

/// The ground's action on a foot.
struct FootLoad {
  Vector<3> force = Vector<3>::Zero();     ///< N
  Vector<3> pressure = Vector<3>::Zero();  ///< m, the centre of pressure
  double free_moment = 0;                  ///< N m, about the plate's upward normal
};

/// A span in which something is on a plate.
struct PlateContact {
  std::size_t plate = 0;
  std::size_t first = 0, last = 0;        ///< samples
  std::optional<double> strike_s, off_s;  ///< from the first row of the feet; nothing if it is cut by the recording's end
  std::optional<Side> side;               ///< nothing if it is not one foot's, whole
  std::string reason;                     ///< why there is no side
};

struct FootForces {
  double rate_hz = 0;                                        ///< of the plates
  std::array<std::vector<std::optional<FootLoad>>, 2> feet;  ///< left, right; by sample; nothing if the foot is on no plate
  std::vector<PlateContact> contacts;
  std::vector<GaitEvent> events;  ///< by time; times count from the first row of the feet
  std::vector<std::string> warnings;
};

/// Plates have one rate and begin at one time. `begin_s` is that of the feet's first row. Throws Error if rates differ.
FootForces foot_forces(std::span<const ForcePlate> plates, const FeetPaths& feet, double feet_rate_hz, double begin_s,
                       const FootForceOptions& options = {});

/// Brings a plate's loads to zero where nothing is on it. Says what was removed if that is more than 5 N, or that it is never free.
std::optional<std::string> remove_offset(ForcePlate& plate);

/// Kinematic events replaced by those of forces.
struct PreferredEvents {
  struct Difference {
    std::size_t count = 0;
    double mean_s = 0, deviation_s = 0;  ///< kinematic − force
  };
  std::vector<GaitEvent> events;
  Difference strikes, offs;
  std::size_t added = 0;  ///< of forces, without a kinematic one within 0.15 s
};
PreferredEvents prefer_forces(std::span<const GaitEvent> kinematic, std::span<const GaitEvent> forces);

}  // namespace marey::analyse::gait
