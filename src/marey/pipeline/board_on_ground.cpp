#include "marey/pipeline/board_on_ground.h"

#include <cmath>

#include "marey/calibrate/board/board_detector.h"
#include "marey/calibrate/board/board_pose.h"
#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"
#include "marey/pipeline/feed.h"

namespace marey::pipeline {
namespace {

constexpr int kMostPictures = 50;     // of a source that are searched for the board
constexpr double kDisagree_m = 0.05;  // between cameras

std::optional<Rigid3> camera_from_board(const RigCamera& camera, const calibrate::board::Board& board) {
  Feed feed(camera, CameraId{}, {.ahead = 0});
  const calibrate::board::BoardDetector detector(board);
  for (int i = 0; i < kMostPictures; ++i) {
    const auto given = feed.next();
    if (!given) break;
    const auto view = detector.detect(given->frame.picture);
    if (!view) continue;
    if (const auto pose = calibrate::board::board_pose(board, *view, *feed.camera().lens)) return pose;
  }
  return std::nullopt;
}

}  // namespace

calibrate::GroundFound board_on_ground(const Rig& rig, const calibrate::board::Board& board) {
  // A board's z runs away from who looks at it: into the floor.
  const Rigid3 board_from_ground{Vector<3>(1, -1, -1).asDiagonal(), Vector<3>::Zero()};
  std::vector<Rigid3> found;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.source.empty() || !camera.camera()) continue;
    const auto pose = camera_from_board(camera, board);
    if (pose) found.push_back(camera.camera_from_world->inverse() * *pose * board_from_ground);
  }
  if (found.empty())
    throw Error("{}", "no camera that has a source, a lens and a pose sees the board: lay it where one does, and check --board");
  Matrix<3> turn = Matrix<3>::Zero();
  Vector<3> origin = Vector<3>::Zero();
  for (const Rigid3& one : found) {
    turn += one.rotation;
    origin += one.translation / static_cast<double>(found.size());
  }
  const geometry::SingularValues3 svd = geometry::singular_values(turn);
  calibrate::GroundFound ground;
  ground.ground_from_world = Rigid3{svd.U * svd.V.transpose(), origin}.inverse();
  double square = 0;
  for (const Rigid3& one : found) square += (one.translation - origin).squaredNorm();
  ground.rms_mm = 1000 * std::sqrt(square / static_cast<double>(found.size()));
  ground.seen_by = {static_cast<int>(found.size())};
  if (ground.rms_mm > 1000 * kDisagree_m) {
    throw Error(
        "the cameras place the board {:.0f} mm apart: it was moved between their pictures, or the rig is not of these cameras",
        ground.rms_mm);
  }
  return ground;
}

}  // namespace marey::pipeline
