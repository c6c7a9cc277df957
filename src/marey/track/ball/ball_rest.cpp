// Cost: for each beginning and end of a path, the things seen near it in some seconds, against each other.
#include "marey/track/ball/ball_rest.h"

#include <algorithm>
#include <cmath>

namespace marey::track::ball {
namespace {

using Trajectory = std::vector<std::optional<BallState>>;

/// An instant seen from the end of a path: forwards in time or backwards.
struct Walk {
  std::ptrdiff_t from, step, count;  // the first moment, ±1, and how many there are

  std::size_t at(std::ptrdiff_t i) const { return static_cast<std::size_t>(from + i * step); }
};

enum class LocalClutter { any, alone };

/// Who sees something where the ball would lie; `alone`: that is not a part of a person.
CameraMask observed_at(const Vector<3>& location, const BallObservations& time_step, const GroundViews& views,
                       const BallRestOptions& options, LocalClutter local_clutter = LocalClutter::any) {
  CameraMask cameras = 0;
  for (const BallView& view : time_step.views) {
    BallBelief belief;
    belief.mean.head<3>() = location;
    const auto at = project(belief, views.view_at(view.camera, view.time));
    if (!at) continue;
    const auto is = [&](const BallSighting& one) {
      return (one.pixel - at->pixel).norm() < options.within && (local_clutter == LocalClutter::any || !one.on_person);
    };
    if (std::any_of(view.detected.begin(), view.detected.end(), is)) cameras |= mask_of(view.camera);
  }
  return cameras;
}

/// Of the instants within `look` s from a walk's beginning, those in which something is seen; nothing if they are few.
std::optional<double> fraction_observed(const Vector<3>& location, const Walk& walk, double inspect, LocalClutter local_clutter,
                                        std::span<const BallObservations> time_steps, const GroundViews& views,
                                        const BallRestOptions& options) {
  std::ptrdiff_t inspected = 0, detected = 0;
  for (std::ptrdiff_t i = 0; i < walk.count; ++i) {
    if (std::abs(seconds(time_steps[walk.at(i)].time - time_steps[walk.at(0)].time)) > inspect) break;
    ++inspected;
    detected += observed_at(location, time_steps[walk.at(i)], views, options, local_clutter) != 0 ? 1 : 0;
  }
  constexpr std::ptrdiff_t kMinInstants = 5;  // instants
  if (inspected < kMinInstants) return std::nullopt;
  return static_cast<double>(detected) / static_cast<double>(inspected);
}

/// Places on the ground near `end` where something is seen in the instants of a walk.
std::vector<Vector<3>> positions_near(const Vector<3>& end, const Walk& walk, std::span<const BallObservations> time_steps,
                                      const GroundViews& views, const BallRestOptions& options) {
  constexpr double kApart = 0.1;  // m
  std::vector<Vector<3>> locations;
  for (std::ptrdiff_t i = 0; i < walk.count; i += 3) {
    if (std::abs(seconds(time_steps[walk.at(i)].time - time_steps[walk.at(0)].time)) > options.inspect) break;
    for (const BallView& view : time_steps[walk.at(i)].views) {
      const GroundView& ground = views.view_at(view.camera, view.time);
      for (const BallSighting& one : view.detected) {
        const auto met = ground.location(one.pixel);
        if (!met || ground.camera()->centre().z() <= kBallRadius) continue;
        const Vector<3> centre = ground.camera()->centre(), foot(met->ground.x(), met->ground.y(), 0);
        const Vector<3> location = foot + kBallRadius / centre.z() * (centre - foot);
        const auto known = [&](const Vector<3>& other) { return (other - location).norm() < kApart; };
        if ((location - end).norm() > options.reach || std::any_of(locations.begin(), locations.end(), known)) continue;
        locations.push_back(location);
      }
    }
  }
  return locations;
}

/// Where it lay in the instants of `rest`, if it did, and was gone in those of `play`.
std::optional<Vector<3>> lay_at(const Vector<3>& end, const Walk& rest, const Walk& play,
                                std::span<const BallObservations> time_steps, const GroundViews& views,
                                const BallRestOptions& options) {
  std::optional<Vector<3>> best;
  double maximum = 0;
  for (const Vector<3>& location : positions_near(end, rest, time_steps, views, options)) {
    const auto fraction = [&](const Walk& walk, double inspect, LocalClutter local_clutter) {
      return fraction_observed(location, walk, inspect, local_clutter, time_steps, views, options);
    };
    const auto detected = fraction(rest, options.inspect, LocalClutter::any);
    if (!detected || *detected < options.detected) continue;
    constexpr double kLong = 4, kAlone = 0.25;  // s, and of them: such an object is a part of a person all the while
    if (fraction(rest, kLong, LocalClutter::alone).value_or(0) < kAlone) continue;
    const auto later = fraction(play, options.inspect, LocalClutter::any);
    if (!later || *later > options.gone || *detected - *later <= maximum) continue;
    maximum = *detected - *later;
    best = location;
  }
  return best;
}

/// The first instant, from `end` of a path into it, at which the ball was away from there.
std::ptrdiff_t gone_from(const Trajectory& reported, std::ptrdiff_t end, std::ptrdiff_t step) {
  constexpr std::ptrdiff_t kHiddenSteps = 12;  // instants at the path's end that may belong to either
  constexpr double kAway = 1.5;                // m
  const Vector<3> location = reported[static_cast<std::size_t>(end)]->belief.location();
  std::ptrdiff_t at = end;
  while (at >= 0 && at < std::ssize(reported) && reported[static_cast<std::size_t>(at)] &&
         (reported[static_cast<std::size_t>(at)]->belief.location() - location).norm() < kAway)
    at += step;
  return step > 0 ? std::max(at, end + kHiddenSteps) : std::min(at, end - kHiddenSteps);
}

void add_rest(const Vector<3>& location, const Walk& rest, std::span<const BallObservations> time_steps, const GroundViews& views,
              const BallRestOptions& options, Trajectory& method) {
  std::ptrdiff_t last = -1;
  for (std::ptrdiff_t i = 0; i < rest.count && !method[rest.at(i)]; ++i) {
    const CameraMask cameras = observed_at(location, time_steps[rest.at(i)], views, options);
    const double unobserved =
        std::abs(seconds(time_steps[rest.at(i)].time - time_steps[rest.at(std::max<std::ptrdiff_t>(last, 0))].time));
    if (unobserved > options.unobserved) return;
    if (cameras == 0) continue;
    for (std::ptrdiff_t k = last + 1; k <= i; ++k) {
      BallState state;
      state.mode = BallMode::rolling;
      state.belief.mean.head<3>() = location;
      state.belief.covariance = Matrix<6>::Identity() * 0.01;
      state.cameras = k == i ? cameras : 0;
      method[rest.at(k)] = state;
    }
    last = i;
  }
}

}  // namespace

void add_rests(std::span<const BallObservations> time_steps, const GroundViews& views, const BallRestOptions& options,
               Trajectory& method) {
  constexpr double kHigh = 1;  // m
  const Trajectory reported = method;
  const std::ptrdiff_t count = std::ssize(reported);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto& here = reported[static_cast<std::size_t>(i)];
    if (!here || here->belief.location().z() > kHigh) continue;  // it flew from elsewhere, as far as is known
    for (const std::ptrdiff_t step : {-1, 1}) {
      const std::ptrdiff_t next = i + step;
      if (next < 0 || next >= count || reported[static_cast<std::size_t>(next)]) continue;
      const Walk rest{next, step, step < 0 ? i : count - next};
      const std::ptrdiff_t played = gone_from(reported, i, -step);
      if (played < 0 || played >= count) continue;
      const Walk play{played, -step, step < 0 ? count - played : played + 1};
      if (const auto location = lay_at(here->belief.location(), rest, play, time_steps, views, options))
        add_rest(*location, rest, time_steps, views, options, method);
    }
  }
}

}  // namespace marey::track::ball
