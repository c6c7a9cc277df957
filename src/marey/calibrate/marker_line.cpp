#include "marey/calibrate/marker_line.h"

#include <cmath>

namespace marey::calibrate {
namespace {

constexpr double kSymmetric = 0.03;  // a middle marker this near to the middle, as a share of the length, distinguishes no end

}  // namespace

bool MarkerLine::reversible() const {
  if (markers() == 2) return true;
  return markers() == 3 && std::abs(distances[1] / distances[2] - 0.5) < kSymmetric;
}

}  // namespace marey::calibrate
