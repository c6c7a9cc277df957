#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "marey/calibrate/people/people_pairs.h"
#include "marey/core/geometry.h"

namespace marey::calibrate::people {

/// A point of a person at an instant.
struct PointRow {
  int person = 0;
  double time_s = 0;
  std::size_t point = 0;
};

/// What all cameras show of the people that are matched, on one clock.
struct PeopleViews {
  std::vector<CameraPeople> cameras;
  std::vector<std::vector<int>> identity;  ///< by camera and its people; -1: in no other camera
  std::vector<double> offsets_s;           ///< by camera, in place of its own
  int people = 0;                          ///< identities

  /// Where a camera sees the point, px, `later_frames` of its frames after the row's time; nothing if it does not.
  std::optional<Vector<2>> pixel(const PointRow& row, std::size_t camera, double later_frames = 0) const;
  /// All points at even instants that two cameras show, by time.
  std::vector<PointRow> rows() const;
};

/// At most `maximum` of them, evenly spread, in an order that takes times and points in turn.
std::vector<PointRow> some_of(const std::vector<PointRow>& rows, std::size_t maximum);

/// About `number` of them, as whole people: all that is seen at evenly spread instants.
std::vector<PointRow> some_instants(const std::vector<PointRow>& rows, std::size_t number);

}  // namespace marey::calibrate::people
