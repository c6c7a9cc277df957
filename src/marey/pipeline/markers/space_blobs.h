// The blobs of all calibrated cameras at one instant, in one list.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/instant.h"
#include "marey/core/rig.h"
#include "marey/reconstruct/time_alignment.h"

namespace marey::pipeline::markers {

class SpaceBlobs {
 public:
  /// With `align`, blobs of a frame that is not at the instant's time are moved to where they were then, by the markers' motion.
  SpaceBlobs(const Rig& rig, double rate_hz, bool align);

  /// From now on, cameras with this calibration (by camera of the rig; nothing: none).
  void set_cameras(std::vector<std::optional<Camera>> cameras);

  /// Takes the frames' blobs but those whose position is less certain than 1 px. `expected`: where markers are expected (m).
  void collect(const FrameSet& frames, std::span<const Track<3>> expected);

  /// Valid until the next `collect`.
  std::span<const Observation<2>> all() const { return blobs_; }
  /// The blobs as they are recorded.
  std::vector<ImageObservation> recorded() const;

 private:
  std::vector<bool> calibrated_;  // by camera of the rig
  reconstruct::OwnTime alignment_;
  double rate_hz_;
  bool align_;
  std::vector<Observation<2>> blobs_;
  std::vector<std::optional<double>> sigmas_;  // of `blobs_`, px
};

}  // namespace marey::pipeline::markers
