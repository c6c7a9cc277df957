// The second pass over the ball's trajectory: what was decided (modes, events, what each camera saw) is filtered once more, and
// smoothed backwards (Rauch, Tung, Striebel), so that a whole arc determines each of its places.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/ground_views.h"
#include "marey/core/ids.h"
#include "marey/track/ball/ball_search.h"

namespace marey::track::ball {

/// Where the ball was at one instant.
struct BallState {
  BallMode mode = BallMode::lost;
  BallEvent event = BallEvent::none;
  BallBelief belief;              ///< of no meaning where it is lost
  std::optional<TrackId> holder;  ///< who had it, where it was held
  CameraMask cameras = 0;         ///< who saw it
};

/// One for each instant; `steps` are those of a search over the same instants.
std::vector<BallState> smooth_ball(std::span<const BallObservations> time_steps, std::span<const BallStep> steps,
                                   const GroundViews& views, const BallMotionOptions& options);

}  // namespace marey::track::ball
