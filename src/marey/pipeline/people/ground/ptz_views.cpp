#include "marey/pipeline/people/ground/ptz_views.h"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "marey/core/error.h"

namespace marey::pipeline::people::ground {
namespace {

/// Straight up: no place of the ground is before it.
GroundView no_ground(const PtzCamera& ptz, cv::Size size) {
  return GroundView(geometry::camera_of(ptz.tripod, {0, -std::numbers::pi / 2, 1}, size));
}

/// The frame whose time is nearest; nothing if there is no frame.
const PtzCamera::Turn* turn_at(const PtzCamera& camera, double time_s) {
  const PtzCamera::Turn* nearest = nullptr;
  const auto later = std::lower_bound(camera.rotations.begin(), camera.rotations.end(), time_s,
                                      [](const PtzCamera::Turn& turn, double time) { return turn.time_s < time; });
  if (later != camera.rotations.end()) nearest = &*later;
  if (later == camera.rotations.begin()) return nearest;
  const PtzCamera::Turn& before = *std::prev(later);
  return nearest == nullptr || time_s - before.time_s < nearest->time_s - time_s ? &before : nearest;
}

}  // namespace

std::shared_ptr<const PtzCamera> ptz_of(const PtzCameras& all, CameraId camera) {
  const auto index = static_cast<std::size_t>(number(camera));
  return index < all.size() ? all[index] : nullptr;
}

GroundView first_view(const RigCamera& camera, const PtzCamera& ptz, const geometry::GroundSurface& surface) {
  if (!camera.size)
    throw Error("camera \"{}\" turns: the size of its images must be reported; add size = [width, height] to the rig", camera.name);
  const auto known = std::find_if(ptz.rotations.begin(), ptz.rotations.end(),
                                  [](const PtzCamera::Turn& turn) { return turn.heading.has_value(); });
  if (known == ptz.rotations.end())
    throw Error("camera \"{}\" is a PTZ camera, and its view is known in no frame; run marey calibrate ptz", camera.name);
  return GroundView(geometry::camera_of(ptz.tripod, *known->heading, *camera.size), surface);
}

void enter_ptz(GroundViews& views, CameraId id, const RigCamera& camera, const PtzCamera& ptz,
               const geometry::GroundSurface& surface) {
  const double offset = camera.offset_s.value_or(0);
  bool was_lost = false;
  for (std::size_t i = 0; i < ptz.rotations.size(); ++i) {
    const PtzCamera::Turn& turn = ptz.rotations[i];
    const bool lost = !turn.heading;
    if (lost && was_lost) continue;
    was_lost = lost;
    // A frame's turn holds from half a frame before it on, so that rounded times do not matter.
    const double before = i > 0 ? (turn.time_s - ptz.rotations[i - 1].time_s) / 2 : 0.02;
    const Timestamp from = timestamp_from_seconds(turn.time_s + offset - before);
    views.turn(
        id, from,
        lost ? no_ground(ptz, *camera.size) : GroundView(geometry::camera_of(ptz.tripod, *turn.heading, *camera.size), surface));
  }
}

std::optional<geometry::Heading> heading_at(const RigCamera& camera, const PtzCamera& ptz, Timestamp time) {
  const PtzCamera::Turn* turn = turn_at(ptz, seconds(time) - camera.offset_s.value_or(0));
  return turn == nullptr ? std::nullopt : turn->heading;
}

Matrix<2> aim_covariance(const RigCamera& camera, const PtzCamera& ptz, Timestamp time, const Vector<2>& pixel) {
  const PtzCamera::Turn* turn = turn_at(ptz, seconds(time) - camera.offset_s.value_or(0));
  if (turn == nullptr || !turn->heading) return Matrix<2>::Zero();
  constexpr double kStep = 1e-4;  // numerical derivative: rad, and ln of the focal length
  const auto ground_at = [&](const Vector<3>& heading) {
    return GroundView(geometry::camera_of(ptz.tripod, geometry::Heading::of(heading), *camera.size)).location(pixel);
  };
  const auto here = ground_at(turn->heading->as_vector());
  Eigen::Matrix<double, 2, 3> by_heading;
  for (int i = 0; i < 3; ++i) {
    const auto there = ground_at(turn->heading->as_vector() + kStep * Vector<3>::Unit(i));
    if (!here || !there) return Matrix<2>::Zero();
    by_heading.col(i) = (there->ground - here->ground) / kStep;
  }
  return by_heading * turn->position_covariance.value_or(turn->covariance) * by_heading.transpose();
}

}  // namespace marey::pipeline::people::ground
