#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/format/observations.h"
#include "marey/format/take/take_file.h"

namespace marey::format {

/// What the cameras of a take saw, instant by instant, so that it can be solved again: with other options, or another calibration.
class TakeObservations {
 public:
  /// Cameras are known by their names. Throws Error if the take holds nothing that cameras saw, or a camera that is not the
  /// rig's. `rig` is needed here only.
  TakeObservations(const std::string& path, const Rig& rig);

  double rate_hz() const { return reader_.header().rate_hz; }

  /// The next instant, also one at which nothing was seen; nothing at the end. Blobs have been moved to the instant's time.
  std::optional<ObservedFrame> next();

 private:
  take::TakeReader reader_;
  std::vector<CameraId> cameras_;  // of the rig, by camera of the take
};

/// The rig that a take was recorded by. Throws Error if it has none.
Rig rig_of_take(const std::string& path);

}  // namespace marey::format
