// Boxes of people on the ground in each camera's image: as the camera observed them, else as a person who stands at the track's
// position appears there.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/instant.h"
#include "marey/pipeline/people/ground/ground_scene.h"
#include "marey/track/ground/ground_instant.h"
#include "marey/track/image/view_log.h"

namespace marey::pipeline::people::ground {

class GroundBoxes {
 public:
  explicit GroundBoxes(std::size_t cameras) : logs_(cameras) {}

  /// Nothing is kept before this was called.
  void enable() { enabled_ = true; }
  bool enabled() const { return enabled_; }

  /// Which frame each camera gave to an instant; before `add` of that instant. Instants grow.
  void add_frames(const FrameSet& frames);
  /// The boxes that cameras observed of tracks at an instant; shared regions have none.
  void add(const track::ground::GroundInstant& instant, std::span<const track::ground::ObservationMatch> matches);
  /// Forgets all instants.
  void clear() { logs_.assign(logs_.size(), {}); }
  /// Replaces the tracker's tracks by those of the recording; boxes of tracks without one are removed.
  void rename(const std::function<std::optional<TrackId>(TrackId, std::int32_t instant)>& track_of);

  /// Adds the boxes of the instant's samples (positions in the user's frame). `time` is the instant's by the rig's clock, `ball`
  /// the ball's track. After `rename`.
  void add_to(Instant& instant, Timestamp time, const GroundScene& scene, std::optional<TrackId> ball) const;

 private:
  std::optional<Box> box_of(const Sample& sample, std::int64_t instant, Timestamp time, CameraId camera, const GroundScene& scene,
                            const Vector<2>& position) const;

  std::vector<track::image::ViewLog> logs_;  // by camera
  bool enabled_ = false;
};

}  // namespace marey::pipeline::people::ground
