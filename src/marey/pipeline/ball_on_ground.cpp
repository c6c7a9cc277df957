#include "marey/pipeline/ball_on_ground.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "marey/core/ball_track.h"
#include "marey/track/ball/ball_smooth.h"

namespace marey::pipeline {
namespace {

using track::ball::BallMode;
using track::ball::BallMoment;
using track::ball::BallState;

constexpr double kBeyondLines = 12;  // m; farther out nothing is the ball
constexpr double kUnseen = 1.5;      // s without anybody having seen it, after which nobody knows where it is
constexpr double kFastest = 45;      // m/s; what is elsewhere sooner is something else
constexpr double kStill = 0.3;       // m: what stays within it
constexpr double kStands = 1;        // for so many s stands, as a ball that lies still becomes a part of the empty scene, and
constexpr double kLeastWay = 2;      // m; what gets no farther than that is no ball that is played with

/// Who is where, at each moment.
void add_people(const Recording& recording, const reconstruct::GroundArea& area, std::vector<BallMoment>& moments) {
  InstantRows rows(recording);
  auto moment = moments.begin();
  for (std::size_t instant = 0; instant < recording.instants().size(); ++instant) {
    const std::int64_t index = recording.instants()[instant].index;
    while (moment != moments.end() && moment->index < index) ++moment;
    if (moment == moments.end() || moment->index != index) continue;
    for (const auto& [track, row] : rows.at(instant)) {
      const TrackColumns& person = recording.tracks()[track];
      const Vector<2> place = person.place(row);
      const auto velocity = person.velocity(row);
      const Vector<2> here = area.world(place);
      const Vector<2> later = velocity ? area.world(place + velocity->head<2>()) : here;
      moment->people.push_back({person.id(), here, later - here});
    }
  }
}

/// Rows that count: from one sighting to the next where they are near each other, on the pitch or near it.
std::vector<bool> rows_known(const std::vector<BallMoment>& moments, const std::vector<BallState>& states,
                             const reconstruct::GroundArea& area) {
  std::vector<bool> known(states.size(), false);
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].mode == BallMode::lost) {
      last.reset();
      continue;
    }
    if (states[i].cameras == 0) continue;
    const bool near = last && seconds(moments[i].time - moments[*last].time) <= kUnseen;
    for (std::size_t k = near ? *last + 1 : i; k <= i; ++k) known[k] = area.holds(states[k].belief.place().head<2>(), kBeyondLines);
    last = i;
  }
  return known;
}

/// Forgets what is no ball that is played with: what stands, and what gets nowhere between two leaps.
void forget_what_stands(const std::vector<BallMoment>& moments, const std::vector<BallState>& states, std::vector<bool>& known) {
  const auto place = [&](std::size_t i) { return states[i].belief.place(); };
  const auto time = [&](std::size_t from, std::size_t to) { return seconds(moments[to].time - moments[from].time); };
  const auto goes_on = [&](std::size_t i) {
    return i < known.size() && known[i] && (place(i) - place(i - 1)).norm() <= kFastest * time(i - 1, i) + kStill;
  };
  for (std::size_t first = 0, end = 0; first < known.size(); first = end) {
    end = first + 1;
    if (!known[first]) continue;
    while (goes_on(end) && (place(end) - place(first)).norm() < kStill) ++end;
    if (time(first, end - 1) >= kStands)
      std::fill(known.begin() + static_cast<std::ptrdiff_t>(first), known.begin() + static_cast<std::ptrdiff_t>(end), false);
    else
      end = first + 1;
  }
  for (std::size_t first = 0, end = 0; first < known.size(); first = end) {
    end = first + 1;
    if (!known[first]) continue;
    double way = 0;
    for (; goes_on(end); ++end) way = std::max(way, (place(end) - place(first)).norm());
    if (way < kLeastWay)
      std::fill(known.begin() + static_cast<std::ptrdiff_t>(first), known.begin() + static_cast<std::ptrdiff_t>(end), false);
  }
}

Sample sample_of(TrackId id, const BallState& state, const reconstruct::GroundArea& area) {
  Sample sample;
  sample.track = id;
  const Vector<3> place = state.belief.place(), velocity = state.belief.velocity();
  const Vector<2> ground = area.ground(place.head<2>()), along = area.ground_velocity(velocity.head<2>());
  sample.position = {ground.x(), ground.y(), std::max(place.z(), 0.0)};
  sample.velocity = Vector<3>(along.x(), along.y(), velocity.z());
  Matrix<3> turn = Matrix<3>::Identity();
  turn.col(0).head<2>() = area.ground_velocity({1, 0});
  turn.col(1).head<2>() = area.ground_velocity({0, 1});
  sample.covariance = turn * state.belief.covariance.topLeftCorner<3, 3>() * turn.transpose();
  sample.cameras = state.cameras;
  sample.provenance = state.cameras != 0 ? Provenance::measured : Provenance::filled;
  return sample;
}

}  // namespace

std::optional<TrackId> follow_ball(std::vector<BallMoment> moments, const std::shared_ptr<const GroundViews>& views,
                                   const reconstruct::GroundArea& area, const BallOptions& options, const Hooks& hooks,
                                   Recording& recording) {
  add_people(recording, area, moments);
  track::ball::BallSearch search(views, options.search);
  std::vector<track::ball::BallStep> steps;
  for (const BallMoment& moment : moments) {
    if (hooks.stop.stop_requested()) break;
    search.add(moment);
    auto decided = search.take_decided();
    std::move(decided.begin(), decided.end(), std::back_inserter(steps));
  }
  search.finish();
  auto decided = search.take_decided();
  std::move(decided.begin(), decided.end(), std::back_inserter(steps));
  moments.resize(steps.size());
  const std::vector<BallState> states = track::ball::smooth_ball(moments, steps, *views, options.search.motion);
  std::vector<bool> known = rows_known(moments, states, area);
  forget_what_stands(moments, states, known);
  const int last_id = recording.tracks().empty() ? 0 : number(recording.tracks().back().id());
  TrackColumns track({.id = TrackId{last_id + 1}, .label = std::string(kBallLabel), .team = {}}, 3);
  std::size_t instant = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!known[i]) continue;
    while (instant < recording.instants().size() && recording.instants()[instant].index < moments[i].index) ++instant;
    if (instant == recording.instants().size()) break;
    if (recording.instants()[instant].index == moments[i].index)
      track.add(static_cast<std::int32_t>(instant), sample_of(track.id(), states[i], area));
  }
  if (track.empty()) return std::nullopt;
  const TrackId id = track.id();
  recording.put(std::move(track));
  return id;
}

std::optional<Box> ball_box(const GroundView& view, const Vector<2>& place, double height) {
  if (view.camera() == nullptr) return std::nullopt;
  const auto seen = view.camera()->project_with_jacobian({place.x(), place.y(), height + view.surface().height(place)});
  if (!seen || !view.camera()->in_picture(seen->pixel)) return std::nullopt;
  const double radius = track::ball::kBallRadius * std::pow((seen->by_world * seen->by_world.transpose()).determinant(), 0.25);
  return Box::from_centre(seen->pixel, 2 * radius, 2 * radius);
}

}  // namespace marey::pipeline
