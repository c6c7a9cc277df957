#pragma once

#include <ceres/ceres.h>

namespace marey::calibrate {

/// ceres::Solve, silent, with its sums in one order (the same bits from run to run), that ends where its thread is asked to: throws
/// Stopped (core/stop.h).
ceres::Solver::Summary solve(ceres::Solver::Options how, ceres::Problem& problem);

}  // namespace marey::calibrate
