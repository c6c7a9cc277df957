#include "marey/filter/default_motion.h"

#include <cmath>

namespace marey::filter {
namespace {

constexpr double kBodyPixels = 100;              // the named filters' lengths are in px: of people so high
constexpr double kBodyMetres = 1.75;             // and so high
constexpr double kChange = 0.5;                  // s over which an acceleration changes: half a stride
constexpr double kTurn = 1;                      // rad/s, of a person who walks
constexpr double kAgility = 1;                   // 1/s: a person at full speed stops or turns round within a second
constexpr double kSwerves = 0.25;                // 1/s
constexpr double kUnobservedStep = 0.5;          // s: without a velocity, a place strays so far as one that moves does in this time
constexpr double kStationaryFraction = 1.0 / 3;  // of the typical noise, that is left to a person who walks steadily

struct SuitsMotion {
  const DefaultMotion& motion;

  /// Root mean square, as it lasts for kChange.
  double acceleration() const { return motion.acceleration_noise / std::sqrt(kChange); }

  FilterOptions operator()(AlphaBetaOptions options) const { return options; }
  FilterOptions operator()(AlphaBetaVariableOptions options) const { return options; }
  FilterOptions operator()(ExtrapolationOptions options) const { return options; }
  FilterOptions operator()(CustomFilterOptions options) const { return options; }
  FilterOptions operator()(KalmanPaperOptions options) const {
    options.initial_velocity_variance = std::pow(motion.speed / options.frame_rate, 2);
    return options;
  }
  FilterOptions operator()(KalmanOptions options) const {
    options.initial_speed = motion.speed;
    options.acceleration_noise = motion.acceleration_noise;
    return options;
  }
  FilterOptions operator()(KalmanAccelerationOptions options) const {
    options.initial_speed = motion.speed;
    options.initial_acceleration = acceleration();
    options.jerk_noise = acceleration() / std::sqrt(kChange);
    return options;
  }
  FilterOptions operator()(ExtendedKalmanOptions options) const { return ptz(options); }
  FilterOptions operator()(UnscentedKalmanOptions options) const { return ptz(options); }
  FilterOptions operator()(CondensationOptions options) const {
    options.initial_speed = motion.speed;
    if (options.with_velocity) {
      options.velocity_diffusion = motion.acceleration_noise;
    } else {
      options.diffusion = motion.speed * std::sqrt(kUnobservedStep);
    }
    return options;
  }
  FilterOptions operator()(InteractingModelsOptions options) const {
    options.initial_speed = motion.speed;
    options.constant_noise = kStationaryFraction * motion.acceleration_noise;
    options.acceleration = acceleration();
    options.agility = kAgility;
    options.turn_limit = kTurn;
    options.swerve_rate = kSwerves;
    options.swerve_speed = motion.speed;
    return options;
  }

  template <typename Ptz>
  FilterOptions ptz(Ptz options) const {
    options.initial_speed = motion.speed;
    options.noise.acceleration_noise = motion.acceleration_noise;
    options.noise.turn_sigma = kTurn;
    return options;
  }
};

}  // namespace

FilterOptions for_motion(const FilterOptions& options, const DefaultMotion& motion) {
  return std::visit(SuitsMotion{motion}, options);
}

FilterOptions filter_for_people_in_image(std::string_view name) {
  return for_motion(scaled(filter_named(name), 1 / kBodyPixels), kPeopleInHeights);
}

FilterOptions filter_for_people_on_ground(std::string_view name) {
  return for_motion(scaled(filter_named(name), kBodyMetres / kBodyPixels), kPeopleInMetres);
}

}  // namespace marey::filter
