#include "marey/reconstruct/camera_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace marey::reconstruct {
namespace {

using Pose6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kMinPointCount = 6;  // in an image, that say anything of its camera
constexpr int kKnown = 30;                 // frames after which a camera's typical share is known
constexpr int kMemoryOfFraction = 500;     // frames that it is a mean over
constexpr double kFallen = 0.4;            // of its typical share: less, and the camera is doubted
constexpr double kStillObserves = 0.4;     // of as many blobs as normal: fewer, and it is covered
constexpr double kRestored = 0.6;          // of its typical share, that a new place has to explain
constexpr std::size_t kViews = 24;         // frames that a new place is found from
constexpr double kMaxShift = 0.15;         // of the image's width
constexpr double kShiftCell = 8;           // px
constexpr double kWithin[] = {16, 10, 6};  // px between blob and point at first
constexpr double kLastWithin = 5;          // standard deviations, at last, and
constexpr double kMinWithin = 1;           // px at least
constexpr int kRounds = 3;                 // of the last

/// One step of Gauss and Newton's method for the camera's pose: camera_from_world changes by a small rotation and shift.
std::optional<Camera> nudged(const Camera& camera, std::span<const Vector<3>> points, std::span<const Vector<2>> blobs,
                             double huber_px) {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Pose6 g = Pose6::Zero();
  const Rigid3& pose = camera.camera_from_world();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = camera.project_with_jacobian(points[i]);
    if (!at) continue;
    const Vector<3> p = pose * points[i];
    Matrix<3> cross;
    cross << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
    const Eigen::Matrix<double, 2, 3> by_place = at->by_world * pose.rotation.transpose();
    Eigen::Matrix<double, 2, 6> J;
    J << -by_place * cross, by_place;
    const Vector<2> error = at->pixel - blobs[i];
    const double weight = std::min(1.0, huber_px / std::max(error.norm(), 1e-12));
    H.noalias() += weight * J.transpose() * J;
    g.noalias() += weight * J.transpose() * error;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(H);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
  const Pose6 step = -solver.solve(g);
  if (!step.allFinite()) return std::nullopt;
  const Rigid3 move{geometry::rotation_from(step.head<3>()), step.tail<3>()};
  return Camera(camera.lens(), move * pose, camera.size());
}

}  // namespace

CameraWatch::CameraWatch(std::vector<Camera> cameras, std::vector<CameraId> ids) : cameras_(std::move(cameras)) {
  for (const CameraId id : ids) watched_.push_back({.id = id, .views = {}});
}

/// Of the points in the camera's image that others see well enough without it, the share that it has a ray in.
double CameraWatch::fraction_of(std::size_t camera, const Correspondences& found, View& view) const {
  view.points.clear();
  std::size_t own = 0;
  for (std::size_t i = 0; i < found.points.size(); ++i) {
    const SpacePoint& point = found.points[i].point;
    const bool has = (observed_by_[i] & mask_of(watched_[camera].id)) != 0;
    if (point.rays - (has ? 1 : 0) < 2) continue;
    if (!has) {
      const auto pixel = cameras_[camera].project(point.position);
      if (!pixel || !cameras_[camera].in_image(*pixel)) continue;
    }
    view.points.push_back(point.position);
    own += has ? 1 : 0;
  }
  return view.points.empty() ? 0 : static_cast<double>(own) / static_cast<double>(view.points.size());
}

std::optional<MovedCamera> CameraWatch::observe_frame(Timestamp now, std::span<const Observation<2>> detected,
                                                      const Correspondences& found, double noise_px) {
  observed_by_.clear();
  for (const Located& located : found.points) {
    CameraMask& mask = observed_by_.emplace_back(0);
    for (const int i : located.detected) mask |= mask_of(detected[static_cast<std::size_t>(i)].camera);
  }
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    Watched& watched = watched_[c];
    const double fraction = fraction_of(c, found, view_);
    if (view_.points.size() < kMinPointCount) continue;
    const double expected = watched.typical * static_cast<double>(view_.points.size());
    const bool fallen = watched.frames >= kKnown && fraction < kFallen * watched.typical;
    if (!fallen) {
      watched.views.clear();
      watched.frames = std::min(watched.frames + 1, kMemoryOfFraction);
      watched.typical += (fraction - watched.typical) / watched.frames;
      continue;
    }
    view_.blobs.clear();
    for (const Observation<2>& blob : detected) {
      if (blob.camera == watched.id) view_.blobs.push_back(blob.value);
    }
    if (static_cast<double>(view_.blobs.size()) >= kStillObserves * expected) {
      if (watched.views.empty()) watched.since = now;
      watched.views.push_back(view_);
      if (watched.views.size() % kViews != 0) continue;
      const auto moved = find(c, noise_px);
      if (moved) return moved;
      if (watched.views.size() >= 4 * kViews) watched.views.erase(watched.views.begin(), watched.views.begin() + kViews);
    }
  }
  return std::nullopt;
}

/// The shift of the camera's image under which most points find a blob.
std::optional<Vector<2>> CameraWatch::common_shift(std::size_t camera) const {
  const double farthest = kMaxShift * cameras_[camera].size().width;
  const int cells = 2 * static_cast<int>(std::ceil(farthest / kShiftCell)) + 3;
  std::vector<int> votes(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells), 0);
  const auto at = [&](int column, int row) -> int& { return votes[static_cast<std::size_t>(row * cells + column)]; };
  for (const View& view : watched_[camera].views) {
    for (const Vector<3>& point : view.points) {
      const auto pixel = cameras_[camera].project(point);
      if (!pixel) continue;
      for (const Vector<2>& blob : view.blobs) {
        const Vector<2> shift = blob - *pixel;
        if (shift.cwiseAbs().maxCoeff() >= farthest) continue;
        ++at(static_cast<int>(std::floor(shift.x() / kShiftCell)) + cells / 2,
             static_cast<int>(std::floor(shift.y() / kShiftCell)) + cells / 2);
      }
    }
  }
  int maximum = 0;
  Vector<2> best = Vector<2>::Zero();
  for (int row = 1; row + 1 < cells; ++row) {
    for (int column = 1; column + 1 < cells; ++column) {
      int sum = 0;
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) sum += at(column + x, row + y);
      }
      if (sum <= maximum) continue;
      maximum = sum;
      best = {(column - cells / 2 + 0.5) * kShiftCell, (row - cells / 2 + 0.5) * kShiftCell};
    }
  }
  return maximum > 0 ? std::optional(best) : std::nullopt;
}

/// Each point with the blob nearest to where the camera should see it.
std::vector<CameraWatch::Pair> CameraWatch::pairs_of(const Watched& watched, const Camera& camera, const Vector<2>& shift,
                                                     double within) {
  std::vector<Pair> pairs;
  for (const View& view : watched.views) {
    for (const Vector<3>& point : view.points) {
      const auto pixel = camera.project(point);
      if (!pixel) continue;
      const Vector<2>* best = nullptr;
      double nearest = within;
      for (const Vector<2>& blob : view.blobs) {
        const double distance = (blob - *pixel - shift).norm();
        if (distance < nearest) nearest = distance, best = &blob;
      }
      if (best != nullptr) pairs.push_back({point, *best});
    }
  }
  return pairs;
}

std::optional<MovedCamera> CameraWatch::find(std::size_t camera, double noise_px) {
  Watched& watched = watched_[camera];
  auto shift = common_shift(camera);
  if (!shift) return std::nullopt;
  std::vector<double> radii(std::begin(kWithin), std::end(kWithin));
  radii.insert(radii.end(), kRounds, std::max(kLastWithin * noise_px, kMinWithin));
  Camera moved = cameras_[camera];
  std::vector<Vector<3>> points;
  std::vector<Vector<2>> blobs;
  for (const double within : radii) {
    points.clear();
    blobs.clear();
    for (const Pair& pair : pairs_of(watched, moved, *shift, within)) {
      points.push_back(pair.point);
      blobs.push_back(pair.blob);
    }
    if (points.size() < kMinPointCount) return std::nullopt;
    for (int step = 0; step < 4; ++step) {
      const auto better = nudged(moved, points, blobs, within / 3);
      if (!better) return std::nullopt;
      moved = *better;
    }
    shift = Vector<2>::Zero();  // the pose has it now
  }
  const auto pairs = pairs_of(watched, moved, Vector<2>::Zero(), radii.back());
  std::size_t all = 0;
  for (const View& view : watched.views) all += view.points.size();
  if (static_cast<double>(pairs.size()) < kRestored * watched.typical * static_cast<double>(all)) return std::nullopt;
  MovedCamera result{watched.id, watched.since, moved.camera_from_world(), 0, 0, 0, static_cast<int>(pairs.size())};
  for (const Pair& pair : pairs) {
    if (const auto pixel = moved.project(pair.point)) result.rms_px += (*pixel - pair.blob).squaredNorm();
  }
  result.rms_px = std::sqrt(result.rms_px / static_cast<double>(pairs.size()));
  const Rigid3& before = cameras_[camera].camera_from_world();
  result.angle = geometry::angle_axis_of(moved.camera_from_world().rotation * before.rotation.transpose()).norm();
  result.distance = (moved.centre() - cameras_[camera].centre()).norm();
  cameras_[camera] = moved;
  watched.views.clear();
  return result;
}

}  // namespace marey::reconstruct
