#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "marey/core/skeleton.h"
#include "marey/format/skeleton/skeleton_recording.h"

#include "fuzz.h"

namespace marey::fuzz {

/// Parents come before children, and what names a coordinate or a segment names one that is there.
inline void check_skeleton(const Skeleton& skeleton) {
  const int coordinates = static_cast<int>(skeleton.coordinates.size()), segments = static_cast<int>(skeleton.segments.size());
  check(segments > 0);
  for (int s = 0; s < segments; ++s) {
    const Segment& segment = skeleton.segments[static_cast<std::size_t>(s)];
    check(!segment.parent || (*segment.parent >= 0 && *segment.parent < s));
    for (const JointAxis& axis : segment.joint.axes)
      check(!axis.coordinate || (*axis.coordinate >= 0 && *axis.coordinate < coordinates));
  }
  for (const Coordinate& coordinate : skeleton.coordinates)
    check(!coordinate.coupling || (coordinate.coupling->to >= 0 && coordinate.coupling->to < coordinates));
  for (const SkeletonMarker& marker : skeleton.markers)
    check(marker.segment >= 0 && marker.segment < segments && marker.position.allFinite());
  pose_of(skeleton, skeleton.rest());
  bodies_of(skeleton);
}

/// As a recording: as many points and bodies in every instant, all of them somewhere.
inline void check_recording(format::skeleton::SkeletonFile file) {
  const auto reader = format::skeleton::recording_of(std::move(file), "file");
  check(reader->header().rate_hz > 0);
  while (const auto instant = reader->next()) {
    check(instant->samples.size() == reader->tracks().size() && instant->bodies.size() == reader->header().bodies.size());
    for (const Sample& point : instant->samples) check(!point.position.array().isNaN().any());
  }
}

/// Every line of a message begins with the file's name and is fit for a terminal.
inline void check_lines(std::string_view message) {
  while (!message.empty()) {
    const std::string_view line = message.substr(0, message.find('\n'));
    check_message(line, "file");
    message.remove_prefix(std::min(message.size(), line.size() + 1));
  }
}

}  // namespace marey::fuzz
