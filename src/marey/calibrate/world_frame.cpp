#include "marey/calibrate/world_frame.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/geometry/decompositions.h"

namespace marey::calibrate {
namespace {

Vector<3> centre_of(const Rigid3& camera_from_world) {
  return camera_from_world.inverse().translation;
}

double distance(const bundle::Bundle& bundle, std::size_t a, std::size_t b) {
  return (centre_of(bundle.cameras[a].camera_from_world) - centre_of(bundle.cameras[b].camera_from_world)).norm();
}

std::size_t index_of(const Rig& rig, const std::string& name) {
  std::size_t c = 0;
  while (rig.cameras[c].name != name) ++c;
  return c;
}

Matrix<3> nearest_rotation(const Matrix<3>& m) {
  const geometry::SingularValues3 svd = geometry::singular_values(m);
  const double sign = (svd.U * svd.V.transpose()).determinant();
  return svd.U * Vector<3>(1, 1, sign).asDiagonal() * svd.V.transpose();
}

/// Onto the poses that were given: rotations averaged, centres matched; scale by the centres' spread where it is not known.
bool onto_given_poses(bundle::Bundle& bundle, const Rig& rig, bool scale_known) {
  Matrix<3> turn = Matrix<3>::Zero();
  Vector<3> given = Vector<3>::Zero(), found = Vector<3>::Zero();
  const auto n = static_cast<double>(rig.cameras.size());
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    if (!rig.cameras[c].camera_from_world) return false;
    const Rigid3 &old = *rig.cameras[c].camera_from_world, &now = bundle.cameras[c].camera_from_world;
    turn += old.rotation.transpose() * now.rotation;
    given += centre_of(old) / n;
    found += centre_of(now) / n;
  }
  double given_spread = 0, found_spread = 0;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    given_spread += (centre_of(*rig.cameras[c].camera_from_world) - given).squaredNorm();
    found_spread += (centre_of(bundle.cameras[c].camera_from_world) - found).squaredNorm();
  }
  const double scale = scale_known || given_spread <= 0 ? 1 : std::sqrt(given_spread / found_spread);
  const Matrix<3> rotation = nearest_rotation(turn);
  move(bundle, {rotation, given / scale - rotation * found}, scale);
  return true;
}

/// Upright as the cameras stand: most are held so that down in the image is down.
void stand_upright(bundle::Bundle& bundle) {
  Vector<3> up = Vector<3>::Zero(), middle = Vector<3>::Zero();
  for (const bundle::BundleCamera& camera : bundle.cameras) up -= camera.camera_from_world.rotation.row(1).transpose();
  up = up.norm() > 1e-3 ? up.normalized() : Vector<3>(Vector<3>::UnitZ());
  for (const bundle::BundleObservation& detected : bundle.observations) {
    middle += bundle::marker_position(bundle, detected) / static_cast<double>(bundle.observations.size());
  }
  const Vector<3> right = bundle.cameras.front().camera_from_world.rotation.row(0).transpose();
  const Vector<3> x = (right - right.dot(up) * up).norm() > 1e-3 ? (right - right.dot(up) * up).normalized() : up.unitOrthogonal();
  Matrix<3> rotation;
  rotation << x.transpose(), up.cross(x).transpose(), up.transpose();
  move(bundle, {rotation, -rotation * middle}, 1);
}

}  // namespace

void move(bundle::Bundle& bundle, const Rigid3& moved_from_world, double scale) {
  const auto moved = [&](const Vector<3>& p) { return Vector<3>(scale * (moved_from_world * p)); };
  for (bundle::BundleCamera& camera : bundle.cameras) {
    const Matrix<3> rotation = camera.camera_from_world.rotation * moved_from_world.rotation.transpose();
    camera.camera_from_world = {rotation, -rotation * moved(centre_of(camera.camera_from_world))};
  }
  for (bundle::Body& body : bundle.bodies) {
    if (auto* point = std::get_if<Vector<3>>(&body)) {
      *point = moved(*point);
    } else if (auto* wand = std::get_if<bundle::WandPose>(&body)) {
      *wand = {moved(wand->origin), moved_from_world.rotation * wand->direction};
    } else {
      auto& board = std::get<Rigid3>(body);
      board = {moved_from_world.rotation * board.rotation, moved(board.translation)};
    }
  }
}

void put_into_world(bundle::Bundle& bundle, const wand::WandInput& input, const wand::WandOptions& options,
                    std::vector<std::string>& notes) {
  bool scale_known = input.wand.markers() > 1;
  if (!scale_known && options.distance) {
    const double found =
        distance(bundle, index_of(input.rig, options.distance->first), index_of(input.rig, options.distance->second));
    move(bundle, {}, options.distance->metres / found);
    scale_known = true;
  }
  if (onto_given_poses(bundle, input.rig, scale_known)) {
    notes.emplace_back(scale_known ? "the world is where the given poses have it"
                                   : "the world is where the given poses have it, and as large");
    return;
  }
  if (!scale_known) {
    move(bundle, {}, 1 / distance(bundle, 0, 1));
    notes.push_back(fmt::format("a single light tells no size: the distance of \"{}\" and \"{}\" is taken as 1 m; give --distance",
                                input.rig.cameras[0].name, input.rig.cameras[1].name));
  }
  stand_upright(bundle);
  notes.emplace_back(
      "the world stands as the cameras do, its origin in the middle of what they saw: `marey calibrate ground` sets both");
}

}  // namespace marey::calibrate
