// Force plates and other analog channels of a C3D file, in the world. FORCE_PLATFORM:TYPE 1 (force, centre of pressure, free
// moment), 2 (force and moment about the sensor), 3 (eight forces of four corners, Kistler), 4 (2 behind a calibration matrix);
// the C3D user guide, "Force platform types". Others are named in a warning and omitted.
#pragma once

#include <string>
#include <vector>

#include "marey/core/force_plate.h"
#include "marey/format/auxiliary_data.h"

namespace marey::format::motion {

/// One channel that belongs to no plate, as the file scales it.
struct AnalogChannel {
  std::string label;  ///< "Voltage.L Rect"
  std::string unit;   ///< "V"; empty if the file has none
  std::vector<double> values;
};

/// Plates and channels have the same rate and begin at the same time.
struct AnalogData {
  std::vector<ForcePlate> plates;
  std::vector<AnalogChannel> channels;
  double rate_hz = 0;  ///< samples per second
  double begin_s = 0;  ///< the recording's time of the first sample
  std::vector<std::string> warnings;
};

/// Of the C3D file that a recording was read from, turned as the recording is. Without channels: empty. Loads have the file's sign:
/// C3D specifies the force on the person, so that a standing person's points up. Throws Error if the file cannot be read.
AnalogData read_analog_data(const AuxiliaryData& auxiliary);

}  // namespace marey::format::motion
