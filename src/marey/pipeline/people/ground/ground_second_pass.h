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
#include "marey/pipeline/people/ground/ground_boxes.h"
#include "marey/pipeline/people/ground/ground_scene.h"
#include "marey/pipeline/people/ground/people_on_ground.h"
#include "marey/track/ball/ball_observations.h"
#include "marey/track/ground/offline/ground_recorder.h"

namespace marey::pipeline::people::ground {

struct GroundPeople {
  Recording recording;
  analyse::Teams teams;  ///< its members are the recording's tracks, in order
  std::optional<TrackId> ball;
  std::int64_t links = 0;            ///< of tracks that were lost and continued
  std::int64_t uncertain_links = 0;  ///< of these, with a probability below 0.9
  std::int64_t outside = 0;          ///< people who were never within the area
  double linking_s = 0;              ///< s that the whole pass took
};

/// `joined`: the whole recording's tracks on the world's ground. `header` is that of the result; `boxes` are renamed to its tracks.
/// `ball_candidates` are used only if `options.ball` is set.
GroundPeople second_pass(track::ground::offline::GroundRecorder::Joined joined, const GroundScene& scene,
                         const RecordingHeader& header, GroundBoxes& boxes,
                         std::vector<track::ball::BallObservations> ball_candidates, const PeopleOnGroundOptions& options,
                         const Hooks& hooks);

/// The result, an instant for each of `time_steps` (by its header's clock), with boxes if requested. All arguments must outlive
/// it.
std::unique_ptr<corridor::InstantSource> ground_instants(const GroundPeople& people, const GroundScene& scene,
                                                         const GroundBoxes& boxes,
                                                         const std::vector<Recording::TimeStep>& time_steps);

/// What was counted of it. `with_ball`: the ball was to be tracked too; `ball_searched`: a camera could search for it.
void report_people(const GroundPeople& people, bool with_ball, bool ball_searched, corridor::Summary& summary);

}  // namespace marey::pipeline::people::ground
