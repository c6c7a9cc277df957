#include "marey/pipeline/people/turned_views.h"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "marey/core/error.h"

namespace marey::pipeline::people {
namespace {

/// Straight up: no place of the ground is before it.
GroundView no_ground(const TurningCamera& turning, cv::Size size) {
  return GroundView(geometry::camera_of(turning.tripod, {0, -std::numbers::pi / 2, 1}, size));
}

/// The frame whose time is nearest; nothing where there is none.
const TurningCamera::Turn* turn_at(const TurningCamera& camera, double time_s) {
  const TurningCamera::Turn* nearest = nullptr;
  const auto later = std::lower_bound(camera.turns.begin(), camera.turns.end(), time_s,
                                      [](const TurningCamera::Turn& turn, double time) { return turn.time_s < time; });
  if (later != camera.turns.end()) nearest = &*later;
  if (later == camera.turns.begin()) return nearest;
  const TurningCamera::Turn& before = *std::prev(later);
  return nearest == nullptr || time_s - before.time_s < nearest->time_s - time_s ? &before : nearest;
}

}  // namespace

std::shared_ptr<const TurningCamera> turning_of(const TurningCameras& all, CameraId camera) {
  const auto index = static_cast<std::size_t>(number(camera));
  return index < all.size() ? all[index] : nullptr;
}

GroundView first_view(const RigCamera& camera, const TurningCamera& turning, const geometry::GroundSurface& surface) {
  if (!camera.size)
    throw Error("camera \"{}\" turns: the size of its pictures must be told; add size = [width, height] to the rig", camera.name);
  const auto known = std::find_if(turning.turns.begin(), turning.turns.end(),
                                  [](const TurningCamera::Turn& turn) { return turn.heading.has_value(); });
  if (known == turning.turns.end())
    throw Error("camera \"{}\" turns, and in no frame it is known where it looks; run marey calibrate turning", camera.name);
  return GroundView(geometry::camera_of(turning.tripod, *known->heading, *camera.size), surface);
}

void enter_turns(GroundViews& views, CameraId id, const RigCamera& camera, const TurningCamera& turning,
                 const geometry::GroundSurface& surface) {
  const double offset = camera.offset_s.value_or(0);
  bool was_lost = false;
  for (std::size_t i = 0; i < turning.turns.size(); ++i) {
    const TurningCamera::Turn& turn = turning.turns[i];
    const bool lost = !turn.heading;
    if (lost && was_lost) continue;
    was_lost = lost;
    // A frame's turn holds from half a frame before it on, so that rounded times do not matter.
    const double before = i > 0 ? (turn.time_s - turning.turns[i - 1].time_s) / 2 : 0.02;
    const Timestamp from = timestamp_from_seconds(turn.time_s + offset - before);
    views.turn(id, from,
               lost ? no_ground(turning, *camera.size)
                    : GroundView(geometry::camera_of(turning.tripod, *turn.heading, *camera.size), surface));
  }
}

Matrix<2> aim_covariance(const RigCamera& camera, const TurningCamera& turning, Timestamp time, const Vector<2>& pixel) {
  const TurningCamera::Turn* turn = turn_at(turning, seconds(time) - camera.offset_s.value_or(0));
  if (turn == nullptr || !turn->heading) return Matrix<2>::Zero();
  constexpr double kStep = 1e-4;  // rad, and ln of the focal length
  const auto ground_at = [&](const Vector<3>& heading) {
    return GroundView(geometry::camera_of(turning.tripod, geometry::Heading::of(heading), *camera.size)).place(pixel);
  };
  const auto here = ground_at(turn->heading->as_vector());
  Eigen::Matrix<double, 2, 3> by_heading;
  for (int i = 0; i < 3; ++i) {
    const auto there = ground_at(turn->heading->as_vector() + kStep * Vector<3>::Unit(i));
    if (!here || !there) return Matrix<2>::Zero();
    by_heading.col(i) = (there->ground - here->ground) / kStep;
  }
  return by_heading * turn->covariance * by_heading.transpose();
}

}  // namespace marey::pipeline::people
