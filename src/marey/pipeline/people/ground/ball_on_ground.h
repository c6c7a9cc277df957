// The ball's trajectory over a whole recording, after every person's is known.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/core/ground_views.h"
#include "marey/core/recording.h"
#include "marey/detect/ball/ball_detector.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ball/ball_observations.h"
#include "marey/track/ball/ball_trajectory.h"

namespace marey::pipeline::people::ground {

struct BallOptions {
  detect::ball::BallDetectorOptions detector;
  track::ball::BallTrajectoryOptions trajectory;
};

/// Tracks the ball in `time_steps`, whose people are those of `recording` (in the user's frame, an instant an instant), and puts
/// it into the recording, as a track of three dimensions that is called "ball". Returns its id; nothing if it was never found.
std::optional<TrackId> track_ball(std::vector<track::ball::BallObservations> time_steps,
                                  const std::shared_ptr<const GroundViews>& views, const reconstruct::GroundArea& area,
                                  const BallOptions& options, const Hooks& hooks, Recording& recording);

/// The box of a ball in a camera's image, px: its centre is over `place` (m, world), `height` m above the ground. Nothing outside
/// the image, or for a camera that is not known.
std::optional<Box> ball_box(const GroundView& view, const Vector<2>& location, double height);

}  // namespace marey::pipeline::people::ground
