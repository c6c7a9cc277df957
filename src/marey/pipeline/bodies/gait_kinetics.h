// Moments and powers of joints over the gait cycle: out of the walk's own C3D file (Plug-in Gait's, POINT:MOMENTS and POWERS), or
// out of tables that `marey moments` or OpenSim wrote.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/analyse/gait/gait_cycles.h"

namespace marey::pipeline::bodies {

struct GaitKinetics {
  std::vector<analyse::gait::SignalCurve> curves;  ///< "hip moment", …
  std::string source;                              ///< a sentence for the report; empty without curves
};

/// Of hips, knees and ankles, the flexion alone; units N m/kg and W/kg, the file's sign. Rows count from the file's first. Empty
/// for another format, and for a file without them.
GaitKinetics kinetics_in_c3d(const std::string& recording, double rate_hz,
                             std::span<const analyse::gait::GaitCycles::Cycle> cycles);

/// Columns of hips, knees and ankles that end in _l_moment, _r_moment, _l_power, _r_power; times are the recording's, of which
/// `begin_s` is the first row's. N m and W, per kg where the mass is given. Throws Error for a table of uneven times, of other
/// columns, or of another time span.
GaitKinetics kinetics_in_tables(std::span<const std::string> paths, double begin_s, std::optional<double> mass_kg,
                                std::span<const analyse::gait::GaitCycles::Cycle> cycles);

}  // namespace marey::pipeline::bodies
