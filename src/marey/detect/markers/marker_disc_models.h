#pragma once

#include <vector>

#include <Eigen/Core>

#include "marey/detect/markers/marker_fit.h"

namespace marey::detect::markers {

inline constexpr int kMostDiscs = 4;

// Parameters: contrast, background, blur, then x, y, radius of each disc, then half of the path that all of them went, if they did.
enum { kDiscsContrast, kDiscsBackground, kDiscsBlur, kFirstDisc };

// On the stack, whatever the number of discs.
inline constexpr int kMostParameters = kFirstDisc + 3 * kMostDiscs + 2;
using DiscsParameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostParameters, 1>;
using DiscsInformation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters>;

/// One to four discs in a window, at rest or moving together while they were seen. Pixels are told in units of the window.
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

/// Fits a model to the pixels `value` at the window's places by Levenberg-Marquardt. `stiffness` pulls the blur to where it began:
/// two close discs hardly tell it.
DiscsSolution fit_discs(DiscsModel model, const MarkerWindow& window, const std::vector<float>& value, double stiffness);

}  // namespace marey::detect::markers
