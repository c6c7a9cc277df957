// Cost: for each beginning and end of a way, the things seen near it in some seconds, against each other.
#include "marey/track/ball/ball_rest.h"

#include <algorithm>
#include <cmath>

namespace marey::track::ball {
namespace {

using Way = std::vector<std::optional<BallState>>;

/// A moment seen from the end of a way: forwards in time or backwards.
struct Walk {
  std::ptrdiff_t from, step, count;  // the first moment, ±1, and how many there are

  std::size_t at(std::ptrdiff_t i) const { return static_cast<std::size_t>(from + i * step); }
};

enum class Company { any, alone };

/// Who sees something where the ball would lie; `alone`: that is no part of somebody.
CameraMask seen_at(const Vector<3>& place, const BallMoment& moment, const GroundViews& views, const BallRestOptions& options,
                   Company company = Company::any) {
  CameraMask cameras = 0;
  for (const BallView& view : moment.views) {
    BallBelief belief;
    belief.mean.head<3>() = place;
    const auto at = project(belief, views.view_at(view.camera, view.time));
    if (!at) continue;
    const auto is = [&](const BallSighting& one) {
      return (one.pixel - at->pixel).norm() < options.within && (company == Company::any || !one.on_person);
    };
    if (std::any_of(view.seen.begin(), view.seen.end(), is)) cameras |= mask_of(view.camera);
  }
  return cameras;
}

/// Of the moments within `look` s from a walk's beginning, those in which something is seen; nothing where they are few.
std::optional<double> share_seen(const Vector<3>& place, const Walk& walk, double look, Company company,
                                 std::span<const BallMoment> moments, const GroundViews& views, const BallRestOptions& options) {
  std::ptrdiff_t looked = 0, seen = 0;
  for (std::ptrdiff_t i = 0; i < walk.count; ++i) {
    if (std::abs(seconds(moments[walk.at(i)].time - moments[walk.at(0)].time)) > look) break;
    ++looked;
    seen += seen_at(place, moments[walk.at(i)], views, options, company) != 0 ? 1 : 0;
  }
  constexpr std::ptrdiff_t kLeast = 5;  // moments
  if (looked < kLeast) return std::nullopt;
  return static_cast<double>(seen) / static_cast<double>(looked);
}

/// Places on the ground near `end` where something is seen in the moments of a walk.
std::vector<Vector<3>> places_near(const Vector<3>& end, const Walk& walk, std::span<const BallMoment> moments,
                                   const GroundViews& views, const BallRestOptions& options) {
  constexpr double kApart = 0.1;  // m
  std::vector<Vector<3>> places;
  for (std::ptrdiff_t i = 0; i < walk.count; i += 3) {
    if (std::abs(seconds(moments[walk.at(i)].time - moments[walk.at(0)].time)) > options.look) break;
    for (const BallView& view : moments[walk.at(i)].views) {
      const GroundView& ground = views.view_at(view.camera, view.time);
      for (const BallSighting& one : view.seen) {
        const auto met = ground.place(one.pixel);
        if (!met || ground.camera()->centre().z() <= kBallRadius) continue;
        const Vector<3> centre = ground.camera()->centre(), foot(met->ground.x(), met->ground.y(), 0);
        const Vector<3> place = foot + kBallRadius / centre.z() * (centre - foot);
        const auto known = [&](const Vector<3>& other) { return (other - place).norm() < kApart; };
        if ((place - end).norm() > options.reach || std::any_of(places.begin(), places.end(), known)) continue;
        places.push_back(place);
      }
    }
  }
  return places;
}

/// Where it lay in the moments of `rest`, if it did, and was gone in those of `play`.
std::optional<Vector<3>> lay_at(const Vector<3>& end, const Walk& rest, const Walk& play, std::span<const BallMoment> moments,
                                const GroundViews& views, const BallRestOptions& options) {
  std::optional<Vector<3>> best;
  double most = 0;
  for (const Vector<3>& place : places_near(end, rest, moments, views, options)) {
    const auto share = [&](const Walk& walk, double look, Company company) {
      return share_seen(place, walk, look, company, moments, views, options);
    };
    const auto seen = share(rest, options.look, Company::any);
    if (!seen || *seen < options.seen) continue;
    constexpr double kLong = 4, kAlone = 0.25;  // s, and of them: who stands there is a part of somebody all the while
    if (share(rest, kLong, Company::alone).value_or(0) < kAlone) continue;
    const auto later = share(play, options.look, Company::any);
    if (!later || *later > options.gone || *seen - *later <= most) continue;
    most = *seen - *later;
    best = place;
  }
  return best;
}

/// The first moment, from `end` of a way into it, at which the ball was away from there.
std::ptrdiff_t gone_from(const Way& told, std::ptrdiff_t end, std::ptrdiff_t step) {
  constexpr std::ptrdiff_t kHiddenSteps = 12;  // moments at the way's end that may belong to either
  constexpr double kAway = 1.5;                // m
  const Vector<3> place = told[static_cast<std::size_t>(end)]->belief.place();
  std::ptrdiff_t at = end;
  while (at >= 0 && at < std::ssize(told) && told[static_cast<std::size_t>(at)] &&
         (told[static_cast<std::size_t>(at)]->belief.place() - place).norm() < kAway)
    at += step;
  return step > 0 ? std::max(at, end + kHiddenSteps) : std::min(at, end - kHiddenSteps);
}

void add_rest(const Vector<3>& place, const Walk& rest, std::span<const BallMoment> moments, const GroundViews& views,
              const BallRestOptions& options, Way& way) {
  std::ptrdiff_t last = -1;
  for (std::ptrdiff_t i = 0; i < rest.count && !way[rest.at(i)]; ++i) {
    const CameraMask cameras = seen_at(place, moments[rest.at(i)], views, options);
    const double unseen = std::abs(seconds(moments[rest.at(i)].time - moments[rest.at(std::max<std::ptrdiff_t>(last, 0))].time));
    if (unseen > options.unseen) return;
    if (cameras == 0) continue;
    for (std::ptrdiff_t k = last + 1; k <= i; ++k) {
      BallState state;
      state.mode = BallMode::rolling;
      state.belief.mean.head<3>() = place;
      state.belief.covariance = Matrix<6>::Identity() * 0.01;
      state.cameras = k == i ? cameras : 0;
      way[rest.at(k)] = state;
    }
    last = i;
  }
}

}  // namespace

void add_rests(std::span<const BallMoment> moments, const GroundViews& views, const BallRestOptions& options, Way& way) {
  constexpr double kHigh = 1;  // m
  const Way told = way;
  const std::ptrdiff_t count = std::ssize(told);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto& here = told[static_cast<std::size_t>(i)];
    if (!here || here->belief.place().z() > kHigh) continue;  // it flew from elsewhere, as far as anybody knows
    for (const std::ptrdiff_t step : {-1, 1}) {
      const std::ptrdiff_t next = i + step;
      if (next < 0 || next >= count || told[static_cast<std::size_t>(next)]) continue;
      const Walk rest{next, step, step < 0 ? i : count - next};
      const std::ptrdiff_t played = gone_from(told, i, -step);
      if (played < 0 || played >= count) continue;
      const Walk play{played, -step, step < 0 ? count - played : played + 1};
      if (const auto place = lay_at(here->belief.place(), rest, play, moments, views, options))
        add_rest(*place, rest, moments, views, options, way);
    }
  }
}

}  // namespace marey::track::ball
