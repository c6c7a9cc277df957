#include "marey/reconstruct/ground_area.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "marey/core/error.h"

namespace marey::reconstruct {
namespace {

/// The rows whose places count.
TrackColumns rows_in(const GroundArea& area, const TrackColumns& track) {
  TrackColumns kept(track.name, 2);
  kept.reserve(track.size());
  for (std::size_t row = 0; row < track.size(); ++row) {
    if (area.holds(track.place(row))) kept.add(track.at()[row], track.sample(row));
  }
  return kept;
}

}  // namespace

GroundArea::GroundArea(const std::optional<Matrix<3>>& ground_from_world, const std::optional<geometry::PitchSize>& pitch,
                       double margin)
    : pitch_(pitch), margin_(margin) {
  if (!ground_from_world) return;
  const Matrix<3>& H = *ground_from_world;
  if (H.row(2) != Vector<3>(0, 0, H(2, 2)).transpose() || !(std::abs(H.determinant()) > 1e-12))
    throw Error("the rig's ground_from_world must keep parallels parallel: its last row is [0, 0, 1]");
  ground_from_world_ = H / H(2, 2);
  world_from_ground_ = ground_from_world_.inverse();
}

Vector<2> GroundArea::ground(const Vector<2>& world) const {
  return ground_from_world_.topLeftCorner<2, 2>() * world + ground_from_world_.topRightCorner<2, 1>();
}

Vector<2> GroundArea::ground_velocity(const Vector<2>& velocity) const {
  return ground_from_world_.topLeftCorner<2, 2>() * velocity;
}

GroundChange GroundArea::change() const {
  return {[this](const Vector<2>& place) { return ground(place); }, ground_from_world_.topLeftCorner<2, 2>()};
}

Vector<2> GroundArea::world(const Vector<2>& ground) const {
  return world_from_ground_.topLeftCorner<2, 2>() * ground + world_from_ground_.topRightCorner<2, 1>();
}

bool GroundArea::holds(const Vector<2>& world, double slack) const {
  if (!pitch_) return true;
  const Vector<2> at = ground(world);
  const double around = margin_ + slack;
  return at.x() >= -around && at.y() >= -around && at.x() <= pitch_->length + around && at.y() <= pitch_->width + around;
}

KeptPeople people_in(const GroundArea& area, Recording recording) {
  if (recording.header.frame.kind != FrameOfReference::Kind::ground)
    throw Error("{}: who is in the area is asked on the ground of the rig's world, and these positions are {}",
                recording.header.name, to_string(recording.header.frame));
  std::vector<TrackColumns> tracks;
  for (TrackColumns& track : recording.take_tracks()) {
    TrackColumns kept = rows_in(area, track);
    track = TrackColumns({}, 2);
    if (!kept.empty()) tracks.push_back(std::move(kept));
  }
  std::stable_sort(tracks.begin(), tracks.end(),
                   [](const TrackColumns& a, const TrackColumns& b) { return a.at().front() < b.at().front(); });
  KeptPeople people;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const TrackId now{static_cast<int>(i) + 1};
    people.now[tracks[i].id()] = now;
    tracks[i].name.id = now;
    recording.put(std::move(tracks[i]));
  }
  people.recording = on_other_ground(std::move(recording), {FrameOfReference::Kind::user_ground, {}}, area.change());
  return people;
}

}  // namespace marey::reconstruct
