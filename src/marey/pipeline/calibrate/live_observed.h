#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "marey/calibrate/image_coverage.h"
#include "marey/core/camera_health.h"
#include "marey/core/instant.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {

inline constexpr double kInspectEvery = 0.1;  ///< by definition: s between two reports of what live cameras see

/// How far live cameras have seen what calibrates them: a wand that is waved, people who walk.
struct LiveObserved {
  struct Camera {
    CameraHealth health;
    double coverage = 0;     ///< fraction of its image in which it was
    std::int64_t views = 0;  ///< images in which it was
    bool covered = false;    ///< that is enough
    std::vector<int> parts;  ///< in which it was, of 10 × 8 row by row
  };
  /// Two cameras that saw it at the same time.
  struct Shared {
    std::size_t a = 0, b = 0;  ///< a < b, by `cameras`
    std::int64_t views = 0;
    bool enough = false;  ///< to find their relative poses
  };
  double seconds = 0;
  std::vector<Camera> cameras;
  std::vector<Shared> shared;  ///< of all pairs
  /// What each camera sees now: images where it gives some, points, those that count as tracks 1, 2, … (the wand's markers; the
  /// people's points by person). No time of it is exact: cameras' newest frames.
  Instant now;
  bool enough = false;               ///< every camera is covered, and all are chained by views that two of them share
  std::vector<std::string> missing;  ///< what is to be done yet, where that can be said, one sentence each
};

/// With the cameras as they are now.
LiveObserved observed_so_far(const marey::calibrate::ImageCoverage& images, std::span<const corridor::Feed> feeds,
                             const source::LivePolicy& policy);

/// "no camera gave a frame", and of each camera what it says of it.
std::string why_nothing_came(std::span<const corridor::Feed> feeds);

/// The rig's cameras as they were seen: their sizes and rates.
void enter_cameras(Rig& rig, std::span<const corridor::Feed> feeds);

}  // namespace marey::pipeline::calibrate
