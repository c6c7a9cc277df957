// How a ball moves, as Gaussian beliefs of place and velocity: it rolls over the ground, flies, or is at a person's feet. Heights
// count from the ground below. Other prior knowledge (a ball that rolls is 0.11 m up, one at a person's feet is near that person)
// is a measurement like those of cameras, so that a second pass carries it back: the end of an arc shows how far away it was.
#pragma once

#include <cstdint>
#include <optional>

#include "marey/core/geometry.h"
#include "marey/geometry/ground_view.h"
#include "marey/track/ball/ball_observations.h"

namespace marey::track::ball {

inline constexpr double kBallRadius = 0.11;  ///< m

enum class BallMode : std::uint8_t { rolling, flying, held, lost };

/// What happens between two instants.
enum class BallEvent : std::uint8_t {
  none,
  kick,    ///< the velocity is another one: at a person's feet, or off a post
  bounce,  ///< on the ground
  land,    ///< it rolls from here on
  take,    ///< it is at a person's feet from here on
};

/// From the physics of a football; what has none is a first guess, of which no sweep was made yet (bench/ball.py is for that).
struct BallMotionOptions {
  double roll_accel = 3;                   ///< m/s², what rolling ball's velocity wanders by in a second
  double flight_accel = 2;                 ///< m/s², the same in the air, sideways: curl, wind; a fifth of it upwards
  double grass = 0.8;                      ///< m/s² that grass takes from a rolling ball
  double drag = 0.0133;                    ///< 1/m, of the air
  double restitution = 0.6, along = 0.85;  ///< of the speed downwards and along, what a bounce leaves
  double kick_speed = 12;                  ///< m/s, deviation of a kicked ball's horizontal velocity in each axis
  double kick_up = 5;                      ///< m/s, the same upwards, about as much on average
  double hold_radius = 0.6;                ///< m, deviation of a ball from the person who has it
  double hold_wander = 0.2;                ///< m, by which it moves at that person's feet from frame to frame (of 1/25 s)
};

/// Place (m, world, z above the ground) and velocity (m/s).
struct BallBelief {
  Vector<6> mean = Vector<6>::Zero();
  Matrix<6> covariance = Matrix<6>::Identity();

  Vector<3> location() const { return mean.head<3>(); }
  Vector<3> velocity() const { return mean.tail<3>(); }
};

/// A belief some time later, with what a smoother needs: it was mean → F · (·) near the mean, and noise came to it.
struct BallPrediction {
  BallBelief belief;
  Matrix<6> F = Matrix<6>::Identity();
};

/// `step` s later: `mode` is how it moves in between, after `event` at their beginning (for `bounce`: at their end). `holder` where
/// it is held. Nothing is measured: the covariance is F P Fᵀ and noise.
BallPrediction predict(const BallBelief& before, BallMode mode, BallEvent event, double step, const BallPerson* holder,
                       const BallMotionOptions& options);

/// What the mode and the event of a step say of the place by themselves. Returns minus half the squared distance (Mahalanobis) of
/// the belief from that.
double settle(BallBelief& belief, BallMode mode, BallEvent event, double step, const BallPerson* holder,
              const BallMotionOptions& options);

/// Where a belief is seen, and how exactly that is known.
struct BallProjection {
  Vector<2> pixel;
  Eigen::Matrix<double, 2, 6> by_state;  ///< ∂pixel/∂state
  Matrix<2> spread;                      ///< px²: of the belief alone
  double radius = 0;                     ///< px, of the ball there
};

/// Nothing if it is not before the camera. The projection is straightened out at `around` (a place, m), by default the
/// belief's own.
std::optional<BallProjection> project(const BallBelief& belief, const GroundView& view,
                                      const std::optional<Vector<3>>& around = std::nullopt);

/// Corrects the belief by a pixel, and returns the logarithm of the pixel's density, 1/px².
double correct(BallBelief& belief, const BallProjection& observed_at, const BallSighting& sighting);

}  // namespace marey::track::ball
