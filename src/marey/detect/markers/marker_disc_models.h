#pragma once

#include <vector>

#include <Eigen/Core>

#include "marey/detect/markers/marker_fit.h"
#include "marey/detect/markers/marker_kernel.h"

namespace marey::detect::markers {

// On the stack, whatever the number of discs; their order is that of marker_kernel.h.
using DiscsParameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxParameters, 1>;
using DiscsInformation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;

/// One to four discs in a window, at rest or moving together while they were seen. Pixels are reported in units of the window.
struct DiscsModel {
  DiscsParameters p;
  int discs = 1;
  bool swept = false;
  bool adds = false;     ///< discs add up instead of hiding each other
  double ceiling = 1e9;  ///< where they add up: saturation, in units of the window
};

/// The least squares problem linearised: JᵀJ, Jᵀr and r².
struct DiscsNormal {
  DiscsInformation information;
  DiscsParameters gradient;
  double squares = 0;
};

struct DiscsSolution {
  DiscsModel model;
  DiscsNormal normal;
};

/// The problem at `model`, for the pixels `value` (padded as the window is) at the window's places.
DiscsNormal linearised(const DiscsModel& model, const MarkerWindow& window, const std::vector<float>& value,
                       const MarkerKernels& kernels = marker_kernels());

/// Fits a model to the pixels `value` at the window's places by Levenberg-Marquardt. `stiffness` pulls the blur to where it began:
/// two close discs barely determine it.
DiscsSolution fit_discs(DiscsModel model, const MarkerWindow& window, const std::vector<float>& value, double stiffness);

}  // namespace marey::detect::markers
