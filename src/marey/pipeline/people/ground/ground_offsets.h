#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "marey/calibrate/pitch/ground_offset.h"
#include "marey/core/rig.h"
#include "marey/detect/detectors.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::pipeline::people::ground {

/// Who was seen where by each camera, kept apart by camera: what offsets are found from. 56 bytes a person, camera and frame, of
/// the first twenty seconds only.
class GroundPathLog {
 public:
  /// `offsets`: of each camera, s, that its times were moved by.
  explicit GroundPathLog(std::vector<double> offsets) : offsets_(std::move(offsets)) {}

  /// What cameras saw at one instant, and whose it was found to be.
  void add(std::span<const track::ground::CameraObservations> views, std::span<const track::ground::ObservationMatch> matches);

  /// The paths that camera number `camera` saw, by its own clock.
  std::vector<marey::calibrate::pitch::GroundPath> paths(std::size_t camera) const;

 private:
  std::vector<double> offsets_;
  std::map<std::pair<std::size_t, TrackId>, marey::calibrate::pitch::GroundPath> paths_;
};

struct RigOffsetsOptions {
  detect::DetectorOptions detector = detect::people::PeopleDetectorOptions{};  ///< of cameras that give images
  std::optional<double> rate_hz;                                               ///< of cameras of which the rig does not specify it
  track::ground::GroundTrackerOptions tracker;
  double seconds = 60;  ///< of each camera that are inspected
  marey::calibrate::pitch::GroundOffsetOptions search;
};

/// The start times of a rig's cameras.
struct RigOffsets {
  struct Camera {
    std::string name;
    marey::calibrate::pitch::GroundOffset found;  ///< to the first of these
    double offset_s = 0;  ///< to continue with: as found where that is plainly better than what the rig says or else 0
  };
  std::vector<Camera> cameras;        ///< those that see the ground and have images or detections, in the rig's order
  std::vector<std::string> notes;     ///< a sentence for each camera that an offset was found for
  std::vector<std::string> warnings;  ///< a sentence for each of which it cannot be reported
};

/// Whether a person should search for offsets: two cameras or more see the ground, and of one but the first the rig says none.
bool lacks_offsets(const Rig& rig);

/// Processes the beginning of every camera, follows people in each alone, and finds when cameras were started that the rig does not
/// say it of. An offset that the rig says is kept; 0 is too where no other is plainly better. Throws Error if a camera cannot be
/// read; Stopped.
RigOffsets find_rig_offsets(const Rig& rig, const reconstruct::GroundArea& area, const RigOffsetsOptions& options = {},
                            const Hooks& hooks = {});

/// Writes them into the rig where it says none; cameras for which none was found stay without.
void enter_offsets(Rig& rig, const RigOffsets& offsets);

/// A sentence for each camera whose given offset the people it saw contradict, if it is wrong by a few seconds at most: to search
/// farther would take longer than to follow every person.
std::vector<std::string> contradicted_offsets(const Rig& rig, const GroundPathLog& log);

}  // namespace marey::pipeline::people::ground
