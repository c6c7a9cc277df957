// Points in space from blobs, instant by instant: which blobs are one marker, how noisy blobs are, and whether a camera was moved.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/reconstruct/camera_watch.h"
#include "marey/reconstruct/correspond.h"
#include "marey/reconstruct/learned_noise.h"

namespace marey::pipeline::markers {

class SpacePoints {
 public:
  /// `noise_px`: nothing if it is to be learned. Cameras without calibration are omitted, with a warning. Throws Error if fewer
  /// than two have one.
  SpacePoints(const Rig& rig, const reconstruct::CorrespondOptions& options, std::optional<double> noise_px);

  /// Before each `find`. If the last one found that a camera was moved: all cameras of the rig as they are from now on.
  std::optional<std::vector<std::optional<Camera>>> apply_moves();

  /// The points of one instant. Valid until the next call.
  const reconstruct::Correspondences& find(Timestamp now, std::span<const Observation<2>> blobs,
                                           std::span<const Track<3>> expected);

  /// Noise, counts, and the reasons for which expected markers have no point.
  void report(corridor::Summary& summary) const;
  /// Cameras that are omitted or were moved, one sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Counts {
    std::int64_t instants = 0, observations = 0, unexplained = 0, by_two_rays = 0;
    std::map<reconstruct::NoPoint, std::int64_t> missed;
  };

  reconstruct::CorrespondOptions options_for(std::size_t cameras) const;
  void count(std::span<const Observation<2>> blobs, const reconstruct::Correspondences& found);
  void warn_of(const reconstruct::MovedCamera& moved);

  std::vector<std::string> names_;  // of the rig's cameras
  reconstruct::CorrespondOptions options_;
  reconstruct::LearnedNoise noise_;
  std::vector<CameraId> ids_;  // of the cameras that have a calibration
  std::optional<reconstruct::Corresponder> corresponder_;
  std::optional<reconstruct::CameraWatch> watch_;
  std::optional<reconstruct::MovedCamera> moved_;  // found in the last call
  Counts counts_;
  std::vector<std::string> warnings_;
};

}  // namespace marey::pipeline::markers
