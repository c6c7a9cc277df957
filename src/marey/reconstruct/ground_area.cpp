#include "marey/reconstruct/ground_area.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
    if (area.holds(track.location(row))) kept.add(track.at()[row], track.sample(row));
  }
  return kept;
}

std::vector<Vector<2>> corners_of(const std::optional<geometry::PitchSize>& pitch) {
  if (!pitch) return {};
  return {{0, 0}, {pitch->length, 0}, {pitch->length, pitch->width}, {0, pitch->width}};
}

/// Whether a line from the place crosses an odd number of the polygon's edges.
bool contains(const std::vector<Vector<2>>& corners, const Vector<2>& at) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector<2>&a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    if (at.x() < a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

/// m to the nearest edge.
double distance_to(const std::vector<Vector<2>>& corners, const Vector<2>& at) {
  double minimum = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector<2>& a = corners[i];
    const Vector<2> edge = corners[(i + 1) % corners.size()] - a;
    const double along = std::clamp((at - a).dot(edge) / std::max(edge.squaredNorm(), 1e-12), 0.0, 1.0);
    minimum = std::min(minimum, (at - a - along * edge).norm());
  }
  return minimum;
}

}  // namespace

GroundArea::GroundArea(const std::optional<Matrix<3>>& ground_from_world, const std::optional<geometry::PitchSize>& pitch,
                       double margin)
    : GroundArea(ground_from_world, corners_of(pitch), margin) {
  pitch_ = pitch;
}

GroundArea::GroundArea(const std::optional<Matrix<3>>& ground_from_world, std::vector<Vector<2>> corners, double margin)
    : corners_(std::move(corners)), margin_(margin) {
  if (corners_.size() == 1 || corners_.size() == 2) throw Error("an area with {} corners; it needs three or more", corners_.size());
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
  return {[this](const Vector<2>& location) { return ground(location); }, ground_from_world_.topLeftCorner<2, 2>()};
}

Vector<2> GroundArea::world(const Vector<2>& ground) const {
  return world_from_ground_.topLeftCorner<2, 2>() * ground + world_from_ground_.topRightCorner<2, 1>();
}

bool GroundArea::holds(const Vector<2>& world, double slack) const {
  if (corners_.empty()) return true;
  const Vector<2> at = ground(world);
  return contains(corners_, at) || distance_to(corners_, at) <= margin_ + slack;
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
