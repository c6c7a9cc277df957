// OpenSim's ExternalLoads: which columns of a .mot or .sto file are forces on which bodies.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::format::skeleton {

/// Forces on one body over time, in the world (m, z up).
struct ExternalLoad {
  std::string body;
  std::vector<double> times;       ///< s, growing
  std::vector<Vector<3>> forces;   ///< N
  std::vector<Vector<3>> points;   ///< m; where the force acts
  std::vector<Vector<3>> moments;  ///< N m, about the point
};

/// The .xml file and the table that it names. Forces and points must be expressed in ground. Throws Error, with the file, if it is
/// not one, or columns are missing.
std::vector<ExternalLoad> read_external_loads(const std::string& path);

/// Writes `table` (.mot) with loads of the same times, and the .xml of its name beside it. Names of columns have the last letter of
/// the body's name: ground_force_l_vx of calcn_l.
void write_external_loads(const std::string& table, const std::vector<ExternalLoad>& loads);

}  // namespace marey::format::skeleton
