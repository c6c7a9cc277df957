#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// A marker set as recordings show it in which its markers have their names: how far each two are from each other, and how much
/// that varies with the subject's motion. What is needed to name the markers of another recording.
struct LearnedMarkers {
  struct Distance {
    double mean = 0, deviation = 0;  ///< m
    bool operator==(const Distance&) const = default;
  };

  std::vector<std::string> labels;
  std::vector<Vector<3>> locations;  ///< m: one posture in which they were seen, in any right-handed frame with z up
  std::vector<Distance> distances;   ///< of each two, a before b by rows: index_of(a, b)
  /// Whether deviations show what is rigid; false where the subject stood still, and everything was.
  bool moves = true;
  /// Whether it stems from subjects of other sizes than the one it is for: distances are of the mean size, and are to be scaled.
  bool scaled = false;

  std::size_t size() const { return labels.size(); }
  static std::size_t index_of(std::size_t a, std::size_t b) { return a > b ? a * (a - 1) / 2 + b : b * (b - 1) / 2 + a; }
  const Distance& between(std::size_t a, std::size_t b) const { return distances[index_of(a, b)]; }
  Distance& between(std::size_t a, std::size_t b) { return distances[index_of(a, b)]; }

  bool operator==(const LearnedMarkers&) const = default;
};

}  // namespace marey
