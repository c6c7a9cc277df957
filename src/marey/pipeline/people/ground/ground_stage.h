// What the stages of people on the ground share: the recording's header, the boxes in each camera's image, and whether the clocks
// of the cameras agree.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "marey/pipeline/people/ground/ground_boxes.h"
#include "marey/pipeline/people/ground/ground_offsets.h"
#include "marey/pipeline/people/ground/ground_scene.h"
#include "marey/pipeline/people/ground/people_on_ground.h"

namespace marey::pipeline::people::ground {

/// The rig with its cameras as their feeds are. Throws Error if there is no camera, or more than 64.
Rig ground_rig(const Rig& rig, const std::vector<corridor::Feed>& feeds);

class GroundStage : public PeopleOnGround {
 public:
  RecordingHeader header() const override { return header_; }
  void need_boxes() override { boxes_.enable(); }

 protected:
  GroundStage(const std::vector<corridor::Feed>& feeds, const PeopleOnGroundOptions& options, GroundScene scene);

  /// By the header's clock.
  Timestamp own_time(Timestamp rig_time) const { return rig_time - rig_time_offset(header_.time_base, scene_.rig); }

  /// Whose observations were whose at an instant, as it was decided.
  void note(const track::ground::GroundInstant& instant, std::span<const track::ground::ObservationMatch> matches);

  /// In a live run: the confirmed tracks within the area, in the user's coordinates.
  Instant live_instant(const FrameSet& frames, std::span<const Track<2>> tracks) const;
  /// In a live run: adds their boxes if they are wanted.
  void add_live_boxes(const FrameSet& frames, std::span<const track::ground::CameraObservations> observed,
                      std::span<const track::ground::ObservationMatch> matches, Instant& instant);

  /// After the cameras have reported: why there is no person, and cameras without frames or with a wrong offset.
  static void explain_empty_result(corridor::Summary& summary);
  void report_times(corridor::Summary& summary) const;

  PeopleOnGroundOptions options_;
  GroundScene scene_;
  RecordingHeader header_;
  GroundPathLog paths_;
  GroundBoxes boxes_;
};

}  // namespace marey::pipeline::people::ground
