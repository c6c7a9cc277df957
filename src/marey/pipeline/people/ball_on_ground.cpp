#include "marey/pipeline/people/ball_on_ground.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "marey/core/track_kind.h"
#include "marey/reconstruct/person_view.h"

namespace marey::pipeline::people {
namespace {

using track::ball::BallMoment;
using track::ball::BallState;

constexpr double kBeyondLines = 12;  // m beyond where people count; farther out nothing is the ball
constexpr double kOnLines = 0.2;     // m beyond the lines that count as within them: farther out officials and spectators walk

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

/// Where people are who were followed is nobody's ball, though a camera's detector may have missed them.
void add_boxes(const GroundViews& views, std::vector<BallMoment>& moments) {
  for (BallMoment& moment : moments) {
    for (track::ball::BallView& view : moment.views) {
      const GroundView& ground = views.view_at(view.camera, view.time);
      for (const track::ball::BallPerson& person : moment.people) {
        const Vector<3> foot(person.place.x(), person.place.y(), ground.surface().height(person.place));
        if (const auto box = reconstruct::person_box(*ground.camera(), foot)) view.people.push_back(*box);
      }
    }
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
  add_boxes(*views, moments);
  track::ball::BallArea where;
  if (area.bounded()) {
    where.possible = [&](const Vector<2>& place) { return area.holds(place, kBeyondLines); };
    where.pitch = [&](const Vector<2>& place) { return area.holds(place, kOnLines - area.margin()); };
  }
  const auto stop = [&] { return hooks.stop.stop_requested(); };
  const std::vector<std::optional<BallState>> way = track::ball::ball_way(moments, views, where, options.way, stop);
  const int last_id = recording.tracks().empty() ? 0 : number(recording.tracks().back().id());
  TrackColumns track({.id = TrackId{last_id + 1}, .label = std::string(kBallLabel), .team = {}, .kind = TrackKind::ball}, 3);
  std::size_t instant = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (!way[i]) continue;
    while (instant < recording.instants().size() && recording.instants()[instant].index < moments[i].index) ++instant;
    if (instant == recording.instants().size()) break;
    if (recording.instants()[instant].index == moments[i].index)
      track.add(static_cast<std::int32_t>(instant), sample_of(track.id(), *way[i], area));
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

}  // namespace marey::pipeline::people
