// A rigid body out of a recording in which it moves: its markers' places to each other, averaged over the instants.
//
// Generalised Procrustes analysis (Gower 1975): the shape is laid onto each instant by least squares, each instant is brought back
// into the shape's frame, and the shape becomes their mean, until it stands still. Within the mean, what lies far from a marker's
// typical place weighs little (Tukey's biweight). A marker whose place varies several times as much as the others' is loose: it is
// named, and omitted.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/body.h"
#include "marey/core/recording.h"
#include "marey/solve/bodies/symmetry.h"

namespace marey::solve::bodies {

struct DefineOptions {
  std::string name = "body";
  std::vector<std::string> markers = {};  ///< labels; three or more
  std::optional<std::string> pivot = {};  ///< the marker that is the body's origin; nothing: the markers' centroid
  std::optional<std::array<std::string, 3>> axes =
      {};                    ///< x goes from the first to the second, the third is on the side of y; nothing:
                             ///< the world's axes as the body lies at the first instant that counts
  double loose = 3;          ///< this many times the other markers' deviation makes one loose
  double tolerance = 0.004;  ///< m: distances that differ by less than twice that count as the same
};

struct DefinedMarker {
  std::string label;
  double deviation = 0;  ///< m, RMS along one axis
  bool loose = false;    ///< and omitted
};

struct DefinedBody {
  Body body;
  std::vector<DefinedMarker> markers;  ///< as they were asked for
  std::vector<Symmetry> symmetries;
  int instants = 0;          ///< that counted
  double shortest_edge = 0;  ///< m
};

/// Throws Error if a label is missing or borne by two tracks, where too few markers are seen together or fixed to each other, or
/// where they lie in a line.
DefinedBody define_body(const Recording& recording, const DefineOptions& options);

}  // namespace marey::solve::bodies
