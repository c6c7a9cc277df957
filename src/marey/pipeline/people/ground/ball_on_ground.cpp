#include "marey/pipeline/people/ground/ball_on_ground.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "marey/core/track_kind.h"
#include "marey/reconstruct/person_view.h"

namespace marey::pipeline::people::ground {
namespace {

using track::ball::BallObservations;
using track::ball::BallState;

constexpr double kBeyondLines = 12;  // m beyond where people count; farther out nothing is the ball
constexpr double kOnLines = 0.2;     // m beyond the lines that count as within them: farther out officials and spectators walk

/// Who is where, at each instant.
void add_people(const Recording& recording, const reconstruct::GroundArea& area, std::vector<BallObservations>& time_steps) {
  InstantRows rows(recording);
  auto time_step = time_steps.begin();
  for (std::size_t instant = 0; instant < recording.instants().size(); ++instant) {
    const std::int64_t index = recording.instants()[instant].index;
    while (time_step != time_steps.end() && time_step->index < index) ++time_step;
    if (time_step == time_steps.end() || time_step->index != index) continue;
    for (const auto& [track, row] : rows.at(instant)) {
      const TrackColumns& person = recording.tracks()[track];
      const Vector<2> location = person.location(row);
      const auto velocity = person.velocity(row);
      const Vector<2> here = area.world(location);
      const Vector<2> later = velocity ? area.world(location + velocity->head<2>()) : here;
      time_step->people.push_back({person.id(), here, later - here});
    }
  }
}

/// A detection where tracked people are is not a ball, though a camera's detector may have missed them.
void add_boxes(const GroundViews& views, std::vector<BallObservations>& time_steps) {
  for (BallObservations& time_step : time_steps) {
    for (track::ball::BallView& view : time_step.views) {
      const GroundView& ground = views.view_at(view.camera, view.time);
      for (const track::ball::BallPerson& person : time_step.people) {
        const Vector<3> foot(person.location.x(), person.location.y(), ground.surface().height(person.location));
        if (const auto box = reconstruct::person_box(*ground.camera(), foot)) view.people.push_back(*box);
      }
    }
  }
}

Sample sample_of(TrackId id, const BallState& state, const reconstruct::GroundArea& area) {
  Sample sample;
  sample.track = id;
  const Vector<3> location = state.belief.location(), velocity = state.belief.velocity();
  const Vector<2> ground = area.ground(location.head<2>()), along = area.ground_velocity(velocity.head<2>());
  sample.position = {ground.x(), ground.y(), std::max(location.z(), 0.0)};
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

std::optional<TrackId> track_ball(std::vector<BallObservations> time_steps, const std::shared_ptr<const GroundViews>& views,
                                  const reconstruct::GroundArea& area, const BallOptions& options, const Hooks& hooks,
                                  Recording& recording) {
  add_people(recording, area, time_steps);
  add_boxes(*views, time_steps);
  track::ball::BallArea where;
  if (area.bounded()) {
    where.possible = [&](const Vector<2>& location) { return area.holds(location, kBeyondLines); };
    where.pitch = [&](const Vector<2>& location) { return area.holds(location, kOnLines - area.margin()); };
  }
  const auto stop = [&] { return hooks.stop.stop_requested(); };
  const std::vector<std::optional<BallState>> states =
      track::ball::ball_trajectory(time_steps, views, where, options.trajectory, stop);
  const int last_id = recording.tracks().empty() ? 0 : number(recording.tracks().back().id());
  TrackColumns track({.id = TrackId{last_id + 1}, .label = std::string(kBallLabel), .team = {}, .kind = TrackKind::ball}, 3);
  std::size_t instant = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i]) continue;
    while (instant < recording.instants().size() && recording.instants()[instant].index < time_steps[i].index) ++instant;
    if (instant == recording.instants().size()) break;
    if (recording.instants()[instant].index == time_steps[i].index)
      track.add(static_cast<std::int32_t>(instant), sample_of(track.id(), *states[i], area));
  }
  if (track.empty()) return std::nullopt;
  const TrackId id = track.id();
  recording.put(std::move(track));
  return id;
}

std::optional<Box> ball_box(const GroundView& view, const Vector<2>& location, double height) {
  if (view.camera() == nullptr) return std::nullopt;
  const auto detected =
      view.camera()->project_with_jacobian({location.x(), location.y(), height + view.surface().height(location)});
  if (!detected || !view.camera()->in_image(detected->pixel)) return std::nullopt;
  const double radius =
      track::ball::kBallRadius * std::pow((detected->by_world * detected->by_world.transpose()).determinant(), 0.25);
  return Box::from_centre(detected->pixel, 2 * radius, 2 * radius);
}

}  // namespace marey::pipeline::people::ground
