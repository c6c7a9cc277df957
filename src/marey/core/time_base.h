// Whose clock a recording's times follow.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "marey/core/ids.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"

namespace marey {

struct TimeBase {
  enum class Kind : std::uint8_t {
    unspecified,  ///< the source does not specify it
    rig,          ///< the rig's: a camera's times with its `offset_s` added
    camera,       ///< one camera's own
  };

  Kind kind = Kind::unspecified;
  CameraId camera{};  ///< of `camera`

  bool operator==(const TimeBase&) const = default;
};

/// "the rig's clock", "the clock of camera "left"": for sentences to the user.
std::string to_string(const TimeBase& base, const Rig& rig);

/// Added to a time of this base gives the rig's time. Throws Error for an unspecified base, and for a camera that the rig does not
/// have.
Duration rig_time_offset(const TimeBase& base, const Rig& rig);

}  // namespace marey
