// A roll or a flight counts by its evidence: the sum of what its sightings away from people weigh against false things, which are
// as dense as they were counted to be. Bits of false things that by chance lie as a ball would go weigh little; what moves about
// with people, or stays where it is, nothing. Cost: that of the search.
#include "marey/track/ball/ball_trajectory.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace marey::track::ball {
namespace {

/// Instants `first` to `end` − 1 that are one roll, flight, or hold.
struct Piece {
  std::size_t first, end;
};

bool free_mode(BallMode mode) {
  return mode == BallMode::rolling || mode == BallMode::flying;
}

/// Segments without a hold; bounces and landings are within them, kicks between two.
std::vector<Piece> free_pieces(const std::vector<BallStep>& steps) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!free_mode(steps[i].mode)) continue;
    const bool goes_on = !pieces.empty() && pieces.back().end == i && !steps[i].initiated && steps[i].event != BallEvent::kick;
    if (goes_on)
      ++pieces.back().end;
    else
      pieces.push_back({i, i + 1});
  }
  return pieces;
}

/// The fastest that a piece got on over a third of a second, m/s.
double top_speed(const Piece& piece, const std::vector<BallObservations>& time_steps, const std::vector<BallState>& states) {
  constexpr double kOver = 0.32;  // s
  double top = 0;
  for (std::size_t from = piece.first, to = piece.first; to < piece.end; ++to) {
    while (from + 1 < to && seconds(time_steps[to].time - time_steps[from + 1].time) >= kOver) ++from;
    const double later = seconds(time_steps[to].time - time_steps[from].time);
    if (later < kOver) continue;
    top = std::max(top, (states[to].belief.location() - states[from].belief.location()).norm() / later);
  }
  return top;
}

bool is_sure(const Piece& piece, const std::vector<BallObservations>& time_steps, const std::vector<BallStep>& steps,
             const std::vector<BallState>& states, const GroundRegion& pitch, const BallTrajectoryOptions& options) {
  double evidence = 0, distance = 0;
  int detected = 0, beyond = 0;  // instants
  const double speed = top_speed(piece, time_steps, states);
  for (std::size_t i = piece.first; i < piece.end; ++i) {
    evidence += steps[i].evidence;
    detected += steps[i].evidence > 0 ? 1 : 0;
    beyond += steps[i].evidence > 0 && pitch && !pitch(states[i].belief.location().head<2>()) ? 1 : 0;
    distance = std::max(distance, (states[i].belief.location() - states[piece.first].belief.location()).norm());
  }
  const bool plain = speed > options.as_people && 2 * beyond < detected;
  return distance >= options.min_trajectory && evidence >= (plain ? options.min_evidence : options.min_slow);
}

/// Instants at which something was seen that is surely the ball.
std::vector<bool> observed_certainly(const std::vector<BallObservations>& time_steps, const std::vector<BallStep>& steps,
                                     const std::vector<BallState>& states, const GroundRegion& pitch,
                                     const BallTrajectoryOptions& options) {
  std::vector<bool> sure(steps.size(), false);
  for (const Piece& piece : free_pieces(steps)) {
    if (!is_sure(piece, time_steps, steps, states, pitch, options)) continue;
    for (std::size_t i = piece.first; i < piece.end; ++i) sure[i] = steps[i].evidence > 0;
  }
  return sure;
}

/// One person had it between two instants, and no other person.
bool one_had_it(std::span<const BallStep> between) {
  std::optional<TrackId> holder;
  for (const BallStep& step : between) {
    if (!step.holder) continue;
    if (holder && holder != step.holder) return false;
    holder = step.holder;
  }
  return holder.has_value();
}

/// What lies between two sure instants of one path, if they are near each other in time, or one person had the ball.
std::vector<bool> reported(const std::vector<BallObservations>& time_steps, const std::vector<BallStep>& steps,
                           const std::vector<bool>& sure, const BallTrajectoryOptions& options) {
  std::vector<bool> known = sure;
  std::vector<std::size_t> of_way;  // its sure instants
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].mode == BallMode::lost || steps[i].initiated) of_way.clear();
    if (!sure[i]) continue;
    if (!of_way.empty()) {
      const std::size_t last = of_way.back();
      const bool held = one_had_it(std::span(steps).subspan(last + 1, i - last - 1));
      if (seconds(time_steps[i].time - time_steps[last].time) <= (held ? options.unobserved_held : options.unobserved))
        std::fill(known.begin() + static_cast<std::ptrdiff_t>(last), known.begin() + static_cast<std::ptrdiff_t>(i), true);
    }
    of_way.push_back(i);
  }
  return known;
}

}  // namespace

std::vector<std::optional<BallState>> ball_trajectory(std::vector<BallObservations>& time_steps,
                                                      const std::shared_ptr<const GroundViews>& views, const BallArea& area,
                                                      const BallTrajectoryOptions& options, const std::function<bool()>& stop) {
  weigh_sightings(time_steps, *views, options.clutter, area.pitch);
  BallSearchOptions within = options.search;
  within.possible = area.possible;
  BallSearch search(views, within);
  std::vector<BallStep> steps;
  const auto take = [&] {
    auto decided = search.take_decided();
    std::move(decided.begin(), decided.end(), std::back_inserter(steps));
  };
  for (const BallObservations& time_step : time_steps) {
    if (stop && stop()) break;
    search.add(time_step);
    take();
  }
  search.finish();
  take();
  time_steps.resize(steps.size());
  const std::vector<BallState> states = smooth_ball(time_steps, steps, *views, options.search.motion);
  const std::vector<bool> known =
      reported(time_steps, steps, observed_certainly(time_steps, steps, states, area.pitch, options), options);
  std::vector<std::optional<BallState>> distance(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool possible = !area.possible || area.possible(states[i].belief.location().head<2>());
    if (known[i] && possible) distance[i] = states[i];
  }
  add_rests(time_steps, *views, options.rest, distance);
  return distance;
}

}  // namespace marey::track::ball
