#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core/types.hpp>

#include "marey/core/rig.h"
#include "marey/geometry/ground_surface.h"
#include "marey/geometry/pitch.h"

namespace marey::simulate::match {

/// How the cameras stand.
enum class MatchStand {
  round,     ///< evenly round the pitch, 12 m up
  football,  ///< two on one stand, half a metre apart, 7.4 m up, 14 m behind the touchline: left half and right half, with an
             ///< overlap
  corners,   ///< two behind opposite corners, 15 m up
  apart,     ///< as `football`, but each stands at its own quarter of the touchline
  sides,     ///< half of them behind each touchline, 12 m up, each facing its own part of the pitch: few places are seen by
             ///< more than two or three
};

struct MatchCamerasOptions {
  MatchStand stand = MatchStand::round;
  int cameras = 6;               ///< 1 to 64, of `round` and `sides`; the others have two
  std::optional<cv::Size> size;  ///< px; nothing: 1920 × 1080 of these, 3072 × 1728 of the others
  double rate_hz = 25;           ///< frames a second
  double offset_s = 0;           ///< cameras were started up to this much before or after the first
  bool distorted = true;         ///< lenses with Brown's distortion, as cheap cameras have; else pinholes
  geometry::PitchSize pitch;
  geometry::GroundSurface ground = {};  ///< its heights; it is laid under the pitch
};

/// The exact cameras, "cam1", "cam2", …, of the football stand "left" and "right". x, y and z of the world are the pitch's
/// own; on the football stand the pitch's y grows towards the cameras, and `ground_from_world` is a reflection. Sizes, lenses and
/// places are a little different for each seed. Throws Error if an option is out of its domain.
Rig match_cameras(const MatchCamerasOptions& options, std::uint64_t seed);

}  // namespace marey::simulate::match
