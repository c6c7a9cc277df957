// The ground's force on each foot over the gait cycle, in the walker's directions, and which cycles have one.
#pragma once

#include <span>
#include <vector>

#include "marey/analyse/gait/foot_forces.h"
#include "marey/analyse/gait/gait_cycles.h"

namespace marey::analyse::gait {

/// Cycles whose stance is one whole contact of their foot with a plate: from the strike, within 20 ms, to an off before the cycle's
/// end. Only these have forces and moments of joints.
std::vector<GaitCycles::Cycle> cycles_on_plates(const FootForces& forces, std::span<const GaitCycles::Cycle> cycles);

/// Of each side with such a cycle three curves, N: "ahead" along the path of the sacrum during the contact, "medial" across it
/// towards the other foot, "up". 0 while the foot swings. `forces_begin_s` is the time of the plates' first sample from the first
/// row of the feet on.
std::vector<SignalCurve> ground_reaction_curves(const FootForces& forces, double forces_begin_s,
                                                std::span<const GaitCycles::Cycle> cycles, const MarkerPath& sacrum,
                                                double feet_rate_hz);

}  // namespace marey::analyse::gait
