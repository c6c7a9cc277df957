#pragma once

#include <cstdint>

namespace marey {

/// Which camera of a rig; 0 where there is one.
enum class CameraId : int {};

/// Which cameras of a rig: bit i stands for CameraId i. A rig has 64 cameras at most.
using CameraMask = std::uint64_t;

/// A track's name permanently: positive, given in the order of birth, never given twice.
enum class TrackId : int {};

/// A rigid body's or a segment's, positive.
enum class BodyId : int {};

constexpr int number(CameraId id) {
  return static_cast<int>(id);
}
constexpr int number(TrackId id) {
  return static_cast<int>(id);
}
constexpr int number(BodyId id) {
  return static_cast<int>(id);
}

constexpr CameraMask mask_of(CameraId id) {
  return CameraMask{1} << number(id);
}

}  // namespace marey
