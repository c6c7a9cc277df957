// What a file of points may hold that is not a point: analog channels, events, angles of joints. C3D does; a recording does not, so
// that it goes from file to file, or from an analysis into a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::format {

/// What stands beside the points of a file that is read. It goes along where the recording is written as C3D again.
struct AuxiliaryData {
  std::string path;           ///< the file; empty if nothing does
  std::int64_t channels = 0;  ///< analog ones: force plates, EMG
  std::int64_t events = 0;
  bool rotated = false;  ///< the file's world has y up, and the recording was turned

  bool any() const { return channels > 0 || events > 0; }
};

/// Something that happened at one instant.
struct MotionEvent {
  std::string context;  ///< whose: "Left", "Right"
  std::string label;    ///< "Foot Strike"
  double time_s = 0;    ///< the recording's frame with index 0 is at 0 s
};

/// Three angles that are reported together, as those of one joint.
struct AngleTriple {
  std::string label;                           ///< "LKneeAngles"
  std::string description;                     ///< what the three are
  std::vector<std::optional<Vector<3>>> rows;  ///< degrees, an entry a frame, from the first one that is written
};

/// The results of a motion analysis, to be written beside its points.
struct MotionFindings {
  std::vector<MotionEvent> events;  ///< by time; in place of those of the file that was read
  std::vector<AngleTriple> angles;
};

}  // namespace marey::format
