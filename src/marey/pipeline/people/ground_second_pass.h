// People on the ground once the whole recording is known: tracks linked and smoothed, in the user's coordinates, only those within
// the area; teams; the ball.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "marey/analyse/teams.h"
#include "marey/core/recording.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/ground_boxes.h"
#include "marey/pipeline/people/ground_cameras.h"
#include "marey/pipeline/people/people_on_ground.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ball/ball_moment.h"
#include "marey/track/ground/ground_run.h"

namespace marey::pipeline::people {

struct GroundPeople {
  Recording recording;
  analyse::Teams teams;  ///< its members are the recording's tracks, in order
  std::optional<TrackId> ball;
  std::int64_t links = 0;            ///< of tracks that were lost and continued
  std::int64_t uncertain_links = 0;  ///< of these, with a probability below 0.9
  std::int64_t outside = 0;          ///< people who were never within the area
  double seconds = 0;                ///< wall time of this pass
};

/// What the second pass takes of the stage that tracked.
struct GroundTracked {
  const GroundCameras& cameras;
  const reconstruct::GroundArea& area;
  const RecordingHeader& header;  ///< of the result
};

/// Ends `tracking`; `boxes` are renamed to the result's tracks. `ball_candidates` are used only if `options.ball` is set.
GroundPeople second_pass(track::ground::GroundRun& tracking, const GroundTracked& tracked, GroundBoxes& boxes,
                         std::vector<track::ball::BallMoment> ball_candidates, const PeopleOnGroundOptions& options,
                         const Hooks& hooks);

/// The result, one instant for each of `moments` (by the header's clock), with boxes if they are wanted. All arguments must outlive
/// it.
std::unique_ptr<corridor::InstantSource> ground_instants(const GroundPeople& people, const GroundTracked& tracked,
                                                         const GroundBoxes& boxes, const std::vector<Recording::Moment>& moments);

}  // namespace marey::pipeline::people
