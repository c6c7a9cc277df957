// A roll or a flight counts by its evidence: the sum of what its sightings away from people weigh against false things, which are
// as dense as they were counted to be. Bits of false things that by chance lie as a ball would go weigh little; what moves about
// with people, or stays where it is, nothing. Cost: that of the search.
#include "marey/track/ball/ball_way.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace marey::track::ball {
namespace {

/// Moments `first` to `end` − 1 that are one roll, flight, or hold.
struct Piece {
  std::size_t first, end;
};

bool free_mode(BallMode mode) {
  return mode == BallMode::rolling || mode == BallMode::flying;
}

/// Stretches without a hold; bounces and landings are within them, kicks between two.
std::vector<Piece> free_pieces(const std::vector<BallStep>& steps) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!free_mode(steps[i].mode)) continue;
    const bool goes_on = !pieces.empty() && pieces.back().end == i && !steps[i].born && steps[i].event != BallEvent::kick;
    if (goes_on)
      ++pieces.back().end;
    else
      pieces.push_back({i, i + 1});
  }
  return pieces;
}

/// The fastest that a piece got on over a third of a second, m/s.
double top_speed(const Piece& piece, const std::vector<BallMoment>& moments, const std::vector<BallState>& states) {
  constexpr double kOver = 0.32;  // s
  double top = 0;
  for (std::size_t from = piece.first, to = piece.first; to < piece.end; ++to) {
    while (from + 1 < to && seconds(moments[to].time - moments[from + 1].time) >= kOver) ++from;
    const double later = seconds(moments[to].time - moments[from].time);
    if (later < kOver) continue;
    top = std::max(top, (states[to].belief.place() - states[from].belief.place()).norm() / later);
  }
  return top;
}

bool is_sure(const Piece& piece, const std::vector<BallMoment>& moments, const std::vector<BallStep>& steps,
             const std::vector<BallState>& states, const GroundRegion& pitch, const BallWayOptions& options) {
  double evidence = 0, way = 0;
  int seen = 0, beyond = 0;  // moments
  const double speed = top_speed(piece, moments, states);
  for (std::size_t i = piece.first; i < piece.end; ++i) {
    evidence += steps[i].evidence;
    seen += steps[i].evidence > 0 ? 1 : 0;
    beyond += steps[i].evidence > 0 && pitch && !pitch(states[i].belief.place().head<2>()) ? 1 : 0;
    way = std::max(way, (states[i].belief.place() - states[piece.first].belief.place()).norm());
  }
  const bool plain = speed > options.as_people && 2 * beyond < seen;
  return way >= options.least_way && evidence >= (plain ? options.least_evidence : options.least_slow);
}

/// Moments at which something was seen that is surely the ball.
std::vector<bool> seen_surely(const std::vector<BallMoment>& moments, const std::vector<BallStep>& steps,
                              const std::vector<BallState>& states, const GroundRegion& pitch, const BallWayOptions& options) {
  std::vector<bool> sure(steps.size(), false);
  for (const Piece& piece : free_pieces(steps)) {
    if (!is_sure(piece, moments, steps, states, pitch, options)) continue;
    for (std::size_t i = piece.first; i < piece.end; ++i) sure[i] = steps[i].evidence > 0;
  }
  return sure;
}

/// One person had it between two moments, and nobody else.
bool one_had_it(std::span<const BallStep> between) {
  std::optional<TrackId> holder;
  for (const BallStep& step : between) {
    if (!step.holder) continue;
    if (holder && holder != step.holder) return false;
    holder = step.holder;
  }
  return holder.has_value();
}

/// What lies between two sure moments of one way, if they are near each other in time, or one person had the ball.
std::vector<bool> told(const std::vector<BallMoment>& moments, const std::vector<BallStep>& steps, const std::vector<bool>& sure,
                       const BallWayOptions& options) {
  std::vector<bool> known = sure;
  std::vector<std::size_t> of_way;  // its sure moments
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].mode == BallMode::lost || steps[i].born) of_way.clear();
    if (!sure[i]) continue;
    if (!of_way.empty()) {
      const std::size_t last = of_way.back();
      const bool held = one_had_it(std::span(steps).subspan(last + 1, i - last - 1));
      if (seconds(moments[i].time - moments[last].time) <= (held ? options.unseen_held : options.unseen))
        std::fill(known.begin() + static_cast<std::ptrdiff_t>(last), known.begin() + static_cast<std::ptrdiff_t>(i), true);
    }
    of_way.push_back(i);
  }
  return known;
}

}  // namespace

std::vector<std::optional<BallState>> ball_way(std::vector<BallMoment>& moments, const std::shared_ptr<const GroundViews>& views,
                                               const BallArea& area, const BallWayOptions& options,
                                               const std::function<bool()>& stop) {
  weigh_sightings(moments, *views, options.clutter, area.pitch);
  BallSearchOptions within = options.search;
  within.possible = area.possible;
  BallSearch search(views, within);
  std::vector<BallStep> steps;
  const auto take = [&] {
    auto decided = search.take_decided();
    std::move(decided.begin(), decided.end(), std::back_inserter(steps));
  };
  for (const BallMoment& moment : moments) {
    if (stop && stop()) break;
    search.add(moment);
    take();
  }
  search.finish();
  take();
  moments.resize(steps.size());
  const std::vector<BallState> states = smooth_ball(moments, steps, *views, options.search.motion);
  const std::vector<bool> known = told(moments, steps, seen_surely(moments, steps, states, area.pitch, options), options);
  std::vector<std::optional<BallState>> way(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool possible = !area.possible || area.possible(states[i].belief.place().head<2>());
    if (known[i] && possible) way[i] = states[i];
  }
  add_rests(moments, *views, options.rest, way);
  return way;
}

}  // namespace marey::track::ball
