#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/core/ids.h"
#include "marey/geometry/vector.h"

namespace marey {

/// What all cameras together saw of one target at one instant.
struct GroundSample {
  std::int32_t instant = 0;           ///< counts the instants recorded
  std::array<float, 2> place{};       ///< m; the observations' mean by their covariances, brought to the instant
  std::array<float, 3> covariance{};  ///< of `place`, m²: xx, xy, yy
  float score = 1;                    ///< of the surest observation
  CameraMask cameras = 0;
  std::array<std::int8_t, 3> colour{};   ///< L*a*b*, of what was seen
  std::uint8_t colour_deviation = none;  ///< `none` where the colour is not known

  static constexpr std::uint8_t none = 255;

  Vector<2> at() const { return {place[0], place[1]}; }
  Matrix<2> spread() const { return (Matrix<2>() << covariance[0], covariance[1], covariance[1], covariance[2]).finished(); }
  bool has_colour() const { return colour_deviation != none; }
  Vector<3> lab() const { return {static_cast<double>(colour[0]), static_cast<double>(colour[1]), static_cast<double>(colour[2])}; }
};

/// One stretch of one track: the instants at which it was seen.
struct GroundTracklet {
  TrackId track{};
  bool confirmed = false;
  std::vector<GroundSample> samples;
};

}  // namespace marey
