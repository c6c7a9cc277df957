// The ground's forces on the feet of a walk, from the force plates of its C3D file or of another, and muscles' activity.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/analyse/gait/emg_envelope.h"
#include "marey/analyse/gait/foot_forces.h"
#include "marey/format/motion/force_plates.h"
#include "marey/format/skeleton/external_loads.h"
#include "marey/pipeline/bodies/gait_markers.h"

namespace marey::pipeline::bodies {

/// What stands beside a walk's markers. `plates` is another C3D file of the same walk that has them; empty: the walk's own. Throws
/// Error if that file has none, or another frame rate, or other frames.
format::motion::AnalogData read_plates(const std::string& recording, const GaitMarkers& markers, const std::string& plates);

/// Envelopes of the channels whose label names a side and whose unit is a voltage, over the cycles.
std::vector<gait::SignalCurve> emg_curves(const format::motion::AnalogData& analog, double begin_s,
                                          std::span<const gait::GaitCycles::Cycle> cycles);

/// Feet's loads as OpenSim has external loads, low-passed at `cutoff_hz` unless it is 0. Between contacts the points rest.
std::vector<format::skeleton::ExternalLoad> external_loads(const gait::FootForces& forces, double begin_s, const std::string& left,
                                                           const std::string& right, double cutoff_hz);

/// Writes the ground's forces: OpenSim's .mot, with the external loads that name its columns in an .xml of the same name beside it
/// (y up, on calcn_l and calcn_r), or .csv (z up), by the ending.
void write_forces(const std::string& path, const gait::FootForces& forces, double begin_s);

}  // namespace marey::pipeline::bodies
