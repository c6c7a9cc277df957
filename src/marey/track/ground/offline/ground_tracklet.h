#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"
#include "marey/core/ids.h"

namespace marey::track::ground::offline {

/// What all cameras together saw of one target at one instant.
struct GroundSample {
  std::int32_t instant = 0;           ///< counts the instants recorded
  std::array<float, 2> location{};    ///< m; the observations' mean by their covariances, brought to the instant
  std::array<float, 3> covariance{};  ///< of `place`, m²: xx, xy, yy
  float score = 1;                    ///< of the surest observation
  CameraMask cameras = 0;
  std::array<std::int8_t, 3> colour{};   ///< L*a*b*, of the observations
  std::uint8_t colour_deviation = none;  ///< `none` where the colour is not known
  bool shared = false;                   ///< each camera that saw it saw it within a region that others share

  static constexpr std::uint8_t none = 255;

  Vector<2> at() const { return {location[0], location[1]}; }
  Matrix<2> spread() const { return (Matrix<2>() << covariance[0], covariance[1], covariance[1], covariance[2]).finished(); }
  bool has_colour() const { return colour_deviation != none; }
  Vector<3> lab() const { return {static_cast<double>(colour[0]), static_cast<double>(colour[1]), static_cast<double>(colour[2])}; }
};

/// What is taken for one person for a while: the instants at which it was seen.
struct GroundTracklet {
  /// From this sample on, until the next run, the tracker called it `track`.
  struct Run {
    TrackId track{};
    std::size_t first = 0;
  };
  std::vector<Run> runs;  ///< by `first`; the first begins at 0
  bool confirmed = false;
  std::vector<GroundSample> samples;
  bool goes_on = false;  ///< the tracker thought that the next tracklet of the list is the same person; but it was cut off
};

/// The first sample of this instant or a later one.
std::size_t index_from(std::span<const GroundSample> samples, std::int32_t instant);

/// Takes from sample `from` on off and gives it back as a tracklet of its own. 0 < from < samples.
GroundTracklet split(GroundTracklet& tracklet, std::size_t from);

/// Takes samples out: from `from` up to before `end`, not all of them.
void erase(GroundTracklet& tracklet, std::size_t from, std::size_t end);

/// Puts `later`, whose samples are all later, at the end.
void append(GroundTracklet& tracklet, const GroundTracklet& later);

}  // namespace marey::track::ground::offline
