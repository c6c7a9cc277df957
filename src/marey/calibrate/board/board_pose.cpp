#include "marey/calibrate/board/board_pose.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::board {
namespace {

Rigid3 rigid_from(const cv::Mat& rotation, const cv::Mat& translation) {
  return {geometry::rotation_from({rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2)}),
          {translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)}};
}

/// Whether the points span a plane: the smaller of their two spreads is not lost against the larger.
bool spread_out(const std::vector<cv::Point3d>& points) {
  Vector<2> mean = Vector<2>::Zero();
  for (const cv::Point3d& p : points) mean += Vector<2>(p.x, p.y) / static_cast<double>(points.size());
  Matrix<2> scatter = Matrix<2>::Zero();
  for (const cv::Point3d& p : points) {
    const Vector<2> d = Vector<2>(p.x, p.y) - mean;
    scatter += d * d.transpose();
  }
  return scatter.determinant() > 1e-4 * scatter.trace() * scatter.trace();
}

}  // namespace

std::optional<Vector<2>> pixel_of(const geometry::Lens& lens, const Vector<3>& in_camera) {
  return std::visit(
      [&](const auto& model) -> std::optional<Vector<2>> {
        if (model.ahead_only && !(in_camera.z() > 1e-6)) return std::nullopt;
        const Vector<2> pixel = model.principal + model.focal.cwiseProduct(model.distort(in_camera, model.distortion.data()));
        if (!pixel.allFinite()) return std::nullopt;
        return pixel;
      },
      lens);
}

std::optional<double> board_rms(const Board& board, const BoardView& view, const geometry::Lens& lens,
                                const Rigid3& camera_from_board) {
  double square = 0;
  for (const BoardCorner& corner : view.corners) {
    const auto pixel = pixel_of(lens, camera_from_board * board.corner(corner.id));
    if (!pixel) return std::nullopt;
    square += (*pixel - corner.pixel).squaredNorm();
  }
  return std::sqrt(square / static_cast<double>(view.corners.size()));
}

std::optional<Rigid3> board_pose(const Board& board, const BoardView& view, const geometry::Lens& lens) {
  const Camera camera(lens, {}, {1, 1});  // the size plays no part in a bearing
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> directions;
  for (const BoardCorner& corner : view.corners) {
    const auto bearing = camera.bearing(corner.pixel);
    if (!bearing || bearing->z() < 0.05) continue;  // a plane before the camera cannot contain observations at its side
    const Vector<3> at = board.corner(corner.id);
    points.emplace_back(at.x(), at.y(), at.z());
    directions.emplace_back(bearing->x() / bearing->z(), bearing->y() / bearing->z());
  }
  if (points.size() < 4 || !spread_out(points)) return std::nullopt;
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(points, directions, cv::Matx33d::eye(), cv::noArray(), rotations, translations, false, cv::SOLVEPNP_IPPE);
  std::optional<Rigid3> best;
  double minimum = 0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    cv::solvePnPRefineLM(points, directions, cv::Matx33d::eye(), cv::noArray(), rotations[i], translations[i]);
    const Rigid3 pose = rigid_from(rotations[i], translations[i]);
    const auto rms = board_rms(board, view, lens, pose);
    if (rms && (!best || *rms < minimum)) best = pose, minimum = *rms;
  }
  return best;
}

}  // namespace marey::calibrate::board
