#pragma once

namespace marey {

/// Which camera of a rig; 0 where there is one.
enum class CameraId : int {};

/// A track's name for good: positive, given in the order of birth, never given twice.
enum class TrackId : int {};

constexpr int number(CameraId id) {
  return static_cast<int>(id);
}
constexpr int number(TrackId id) {
  return static_cast<int>(id);
}

}  // namespace marey
