// What a camera saw a little before or after the instant that an instant stands for, brought to the instant.
//
// Cameras that run free of each other are exposed up to half a period from the instant. What they saw of a marker then lies beside
// where it is at the moment by its motion in that time: 10 mm at 2 m/s and 5 ms. A blob is moved by the motion of the marker that
// is expected nearest to it in that camera at its own time: the tracker knows velocities far better than two images do. Where no
// marker is expected near, the blob's own motion since the camera's last frame is taken, if there is one blob only that it can be;
// a blob without either stays where it is. Cost: blobs × expected markers of the cameras that are unsynchronised.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"
#include "marey/core/track.h"

namespace marey::reconstruct {

struct OwnTimeOptions {
  double near_px = 12;      ///< a blob that lies no nearer to an expected marker is not taken for it
  double farthest_px = 40;  ///< that a blob may have moved since the last frame
};

class OwnTime {
 public:
  /// Nothing for a camera without calibration.
  explicit OwnTime(std::vector<std::optional<Camera>> cameras, const OwnTimeOptions& options = {});

  /// Moves `blobs`, which `camera` saw at `seen`, to `now`. `expected` is where the tracker expects its markers `now`. To be called
  /// for every frame of a camera, in order; where both times are the same nothing changes.
  void bring(CameraId camera, Timestamp detected, Timestamp now, std::span<Observation<2>> blobs,
             std::span<const Track<3>> expected);

 private:
  struct Last {
    Timestamp time{};
    std::vector<Vector<2>> blobs;
  };
  struct Moving {
    Vector<2> then, now;  // px
  };

  std::optional<Vector<2>> by_expected(const Vector<2>& blob) const;
  std::optional<Vector<2>> by_last(const Vector<2>& blob, const Last& last, double elapsed, double ahead) const;

  OwnTimeOptions options_;
  std::vector<std::optional<Camera>> cameras_;
  std::vector<Last> last_;  // by camera
  std::vector<Moving> moving_;
  std::vector<Vector<2>> before_;
};

}  // namespace marey::reconstruct
