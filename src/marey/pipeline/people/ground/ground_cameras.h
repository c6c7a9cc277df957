// All cameras of a rig that observe one ground: opened once, asked side by side.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/ground_views.h"
#include "marey/core/rig.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/ground/ground_camera.h"
#include "marey/pipeline/people/ground/people_on_ground.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ball/ball_observations.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::pipeline::people::ground {

/// How the cameras see the ground, each with its motion. Throws Error if that is not known of one.
std::shared_ptr<GroundViews> views_of(const Rig& fed, const PtzCameras& ptz);

class GroundCameras {
 public:
  /// `views` and `area` as in a GroundScene. Throws Error if a camera is not calibrated or does not suit the detector.
  GroundCameras(const std::vector<corridor::Feed>& feeds, const std::shared_ptr<GroundViews>& views,
                const reconstruct::GroundArea& area, const PeopleOnGroundOptions& options);

  std::size_t size() const { return cameras_.size(); }
  const GroundCamera& operator[](std::size_t camera) const { return cameras_[camera]; }

  /// Observations of each camera that has a frame, given the tracks `expected` at this time (m, world). Valid until the next call.
  std::span<const track::ground::CameraObservations> observe(const FrameSet& frames, std::span<const Track<2>> expected);
  /// Candidates for the ball in the frames that were observed last.
  track::ball::BallObservations ball_candidates(const FrameSet& frames) const;
  /// Whether any camera searches for the ball.
  bool search_ball() const;

  std::vector<std::shared_ptr<StandingPeople>> standing() const;
  std::vector<std::string> news();
  std::vector<std::string> news_of(std::size_t camera) { return cameras_[camera].news(); }
  void report(corridor::Summary& summary) const;

 private:
  std::vector<GroundCamera> cameras_;
  std::vector<track::ground::CameraObservations> all_, observed_;  // by camera; of those with a frame
};

}  // namespace marey::pipeline::people::ground
