#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// What the cameras saw at an instant, kept.
struct GroundInstant {
  GroundInstant(std::int32_t of_frame, Timestamp at, std::span<const CameraObservations> views)
      : frame(of_frame), time(at), cameras(views.begin(), views.end()) {
    detected.reserve(cameras.size());
    for (CameraObservations& camera : cameras)
      camera.detected = detected.emplace_back(camera.detected.begin(), camera.detected.end());
  }
  GroundInstant(GroundInstant&&) = default;
  GroundInstant& operator=(GroundInstant&&) = default;

  std::size_t observations() const {
    std::size_t count = 0;
    for (const std::vector<Observation<2>>& of : detected) count += of.size();
    return count;
  }

  std::int32_t frame = 0;
  Timestamp time{};
  std::vector<CameraObservations> cameras;
  std::vector<std::vector<Observation<2>>> detected;  ///< what `cameras` refer to
};

}  // namespace marey::track::ground
