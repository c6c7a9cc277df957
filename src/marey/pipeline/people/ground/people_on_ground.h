// Every person on the ground that a rig's cameras observe, under one identity across all of them: each camera's people are placed
// on the ground, one tracker makes identities of all of them, in metres, and what it has decided is joined, smoothed and
// distinguished by teams once the whole recording is known. Everything before the last step is in the rig's right-handed world.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/teams.h"
#include "marey/core/rig.h"
#include "marey/geometry/pitch.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/ground/ball_on_ground.h"
#include "marey/pipeline/people/ground/ground_camera.h"
#include "marey/pipeline/people/ground/ptz_views.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/bramble/bramble_options.h"
#include "marey/track/ground/ground_run.h"
#include "marey/track/ground/ground_tracker.h"
#include "marey/track/ground/offline/ground_recorder.h"

namespace marey::pipeline::people::ground {

struct PeopleOnGroundOptions {
  detect::DetectorOptions detector = detect::people::PeopleDetectorOptions{};  ///< of cameras that give images
  track::ground::GroundTrackerOptions tracker;
  std::optional<track::bramble::BrambleOptions> bramble = {};  ///< in place of detector and tracker: bramble_on_ground.h
  track::ground::offline::GroundJoinOptions join;
  track::ground::GroundLearnOptions learn;   ///< from the recording; not where `live`
  analyse::TeamOptions teams;                ///< `pitch` is taken from below
  std::optional<double> rate_hz;             ///< of cameras of which the rig does not specify it
  std::optional<geometry::PitchSize> pitch;  ///< only people on it count; nothing: every person does
  std::vector<Vector<2>> area;               ///< corners of another part of the ground, m, in place of a pitch; none: none
  PtzCameras ptz;                            ///< of the rig's cameras, those that turn
  std::optional<BallOptions> ball = {};      ///< the ball is followed too; not where `live`
  bool stabilise = false;                    ///< cameras shake: the images of each that stands are stabilised first
  std::vector<std::shared_ptr<const StandingPeople>> without;  ///< by camera: people who are not a part of its scene; may be empty
  double margin = 2;                                           ///< m round the pitch or the area where people still count
  /// Every instant is reported as it comes: nothing is read ahead and nothing improved by what came later.
  bool live = false;
};

/// The part of a rig's ground whose people count.
reconstruct::GroundArea area_of(const Rig& rig, const PeopleOnGroundOptions& options);

/// What the second pass found out of the teams; none where `live`.
class PeopleOnGround : public corridor::Stage {
 public:
  virtual const std::vector<analyse::Teams::Team>& teams() const = 0;
  /// Of each camera who was taken for a part of its scene and has left it; nothing if that is not searched for.
  virtual std::vector<std::shared_ptr<StandingPeople>> standing() const = 0;
};

/// `feeds` are the rig's cameras; instants are those of a clock over them. The results are in the
/// user's coordinates (`ground_from_world`), their times by the first camera's own clock. Memory grows with the rows, not where
/// `live`. Throws Error if a camera is not calibrated or brings nothing.
std::unique_ptr<PeopleOnGround> people_on_ground(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                 const PeopleOnGroundOptions& options);

}  // namespace marey::pipeline::people::ground
