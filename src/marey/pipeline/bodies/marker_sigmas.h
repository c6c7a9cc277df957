// How tightly markers of a person sit where a generic model has them, by their labels: bony landmarks are palpated to a centimetre
// or two, markers of clusters and plates are stuck anywhere on a limb.
#pragma once

#include <string_view>
#include <vector>

#include "marey/core/skeleton.h"

namespace marey::pipeline::bodies {

/// Deviation of a marker's coordinate on its segment, m. Labels of the common sets (Plug-in Gait, Helen Hayes, Cleveland Clinic,
/// CMU, OpenSim's examples) are known; any other has 20 mm.
double marker_sigma(std::string_view label);

/// Of each of the skeleton's markers.
std::vector<double> marker_sigmas(const Skeleton& skeleton);

}  // namespace marey::pipeline::bodies
