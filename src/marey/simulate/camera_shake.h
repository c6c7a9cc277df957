#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::simulate {

/// How a camera on a mast or a stand moves that ought to stand still: wind from 0.3 to 8 Hz, most of it about the mast's own 2 Hz,
/// and steps on the stand, jolts that ring for a third of a second, one every five seconds or so. It pans, tilts and rolls about a
/// rest. The same for the same seed.
class CameraShake {
 public:
  /// `rms_px` is what pan and tilt each move the image's middle by, root mean square without the jolts; `focal` px; roll moves a
  /// place `reach` px off the middle by a third of that.
  CameraShake(double rms_px, double focal, double reach, std::uint64_t seed);

  /// The turn from the rest at `time`, s: a rotation vector, rad, about the camera's x, y and z (right, down, ahead).
  Vector<3> turn(double time) const;

 private:
  struct Wave {
    double rate, phase, strength;  // rad/s, rad, rad
  };
  std::vector<Wave> waves_[3];
  Vector<3> rms_;
  std::uint64_t seed_;
};

/// Where a point seen at a pixel is seen after the turn `turn` of the scene about a pinhole camera.
std::function<Vector<2>(const Vector<2>&)> rotated_pixels(const Vector<3>& turn, double focal, const Vector<2>& principal);

}  // namespace marey::simulate
