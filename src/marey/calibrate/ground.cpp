#include "marey/calibrate/ground.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "marey/calibrate/rays.h"
#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"

namespace marey::calibrate {
namespace {

constexpr double kSamePosition = 3;    // px, within which a blob has stood still
constexpr double kSigmaPx = 1.5;       // of a ray, the rig's own error included
constexpr double kMeet = 3;            // sigmas within which rays meet
constexpr double kDistanceOff = 0.02;  // of a distance between markers, and at least:
constexpr double kDistanceOff_m = 0.005;
constexpr double kBoardsOff_m = 0.05;  // between cameras that see one board

struct SpacePoint {
  Vector<3> location = Vector<3>::Zero();
  std::set<std::pair<std::size_t, std::size_t>> detected;  // camera, blob
  double off = 0;                                          // the worst ray, sigmas
};

struct View {
  Camera camera;
  std::size_t index;
  std::vector<std::optional<SightLine>> lines;  // by blob
};

std::vector<View> views_of(const Rig& rig, std::span<const std::vector<Vector<2>>> blobs) {
  std::vector<View> views;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const auto camera = rig.cameras[c].camera();
    if (!camera) continue;
    View view{*camera, c, {}};
    for (const auto& blob : blobs[c]) {
      const auto ray = camera->ray(blob);
      view.lines.push_back(ray ? std::optional(SightLine{*ray, kSigmaPx / geometry::focal_of(camera->lens()).x()}) : std::nullopt);
    }
    views.push_back(std::move(view));
  }
  return views;
}

/// A point with every ray of another camera that leads to it.
std::optional<SpacePoint> gather(const std::vector<View>& views, Vector<3> location) {
  SpacePoint point;
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<SightLine> lines;
    point.detected.clear();
    point.off = 0;
    for (const View& view : views) {
      std::size_t best = view.lines.size();
      double nearest = kMeet;
      for (std::size_t b = 0; b < view.lines.size(); ++b) {
        const double off = view.lines[b] ? angle_off(*view.lines[b], location) : kMeet;
        if (off < nearest) nearest = off, best = b;
      }
      if (best == view.lines.size()) continue;
      lines.push_back(*view.lines[best]);
      point.detected.insert({view.index, best});
      point.off = std::max(point.off, nearest);
    }
    const auto met = intersection_point(lines);
    if (!met) return std::nullopt;
    location = *met;
  }
  point.location = location;
  return point;
}

std::vector<SpacePoint> points_in_space(const std::vector<View>& views) {
  std::vector<SpacePoint> all;
  for (std::size_t a = 0; a < views.size(); ++a) {
    for (std::size_t b = a + 1; b < views.size(); ++b) {
      for (const auto& from_a : views[a].lines) {
        for (const auto& from_b : views[b].lines) {
          if (!from_a || !from_b) continue;
          const auto location = intersection_point(std::array{*from_a, *from_b});
          if (!location || angle_off(*from_a, *location) > kMeet || angle_off(*from_b, *location) > kMeet) continue;
          if (auto point = gather(views, *location)) all.push_back(std::move(*point));
        }
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const SpacePoint& x, const SpacePoint& y) {
    return x.detected.size() != y.detected.size() ? x.detected.size() > y.detected.size() : x.off < y.off;
  });
  std::vector<SpacePoint> kept;
  std::set<std::pair<std::size_t, std::size_t>> used;
  for (SpacePoint& point : all) {
    if (std::any_of(point.detected.begin(), point.detected.end(), [&](const auto& blob) { return used.contains(blob); })) continue;
    used.insert(point.detected.begin(), point.detected.end());
    kept.push_back(std::move(point));
  }
  return kept;
}

bool same_distance(double found, double required) {
  return std::abs(found - required) <= std::max(kDistanceOff_m, kDistanceOff * required);
}

/// Which points can be the frame's markers: every assignment whose distances fit.
class Matcher {
 public:
  Matcher(std::vector<Vector<3>> points, std::span<const Vector<3>> frame, bool free_scale)
      : points_(std::move(points)), frame_(frame), free_scale_(free_scale) {
    extend();
  }

  const std::vector<std::vector<std::size_t>>& matches() const { return matches_; }

 private:
  double scale() const {
    return free_scale_ && chosen_.size() >= 2 ? (frame_[1] - frame_[0]).norm() / (points_[chosen_[1]] - points_[chosen_[0]]).norm()
                                              : 1;
  }

  bool fits() const {
    const std::size_t last = chosen_.size() - 1;
    if (free_scale_ && last < 2) return true;
    for (std::size_t k = 0; k < last; ++k) {
      const double found = scale() * (points_[chosen_[last]] - points_[chosen_[k]]).norm();
      if (!same_distance(found, (frame_[last] - frame_[k]).norm())) return false;
    }
    return true;
  }

  void extend() {
    if (chosen_.size() == frame_.size()) {
      matches_.push_back(chosen_);
      return;
    }
    for (std::size_t p = 0; p < points_.size(); ++p) {
      if (std::find(chosen_.begin(), chosen_.end(), p) != chosen_.end()) continue;
      chosen_.push_back(p);
      if (fits()) extend();
      chosen_.pop_back();
    }
  }

  std::vector<Vector<3>> points_;
  std::span<const Vector<3>> frame_;
  bool free_scale_;
  std::vector<std::size_t> chosen_;
  std::vector<std::vector<std::size_t>> matches_;
};

void check_frame(std::span<const Vector<3>> frame, bool free_scale) {
  if (frame.size() < 3) throw Error("a ground frame has three markers or more; {} are given", frame.size());
  Matrix<3> spread = Matrix<3>::Zero();
  for (const Vector<3>& marker : frame) spread += (marker - frame[0]) * (marker - frame[0]).transpose();
  const Vector<3> extent = geometry::eigenpairs<3>(spread).values.cwiseMax(0).cwiseSqrt();
  if (extent[1] < 0.02 * extent[2])
    throw Error("{}", "the ground frame's markers lie on a line: the floor could turn about it; use an L");
  if (Matcher({frame.begin(), frame.end()}, frame, free_scale).matches().size() > 1) {
    throw Error("{}", "the ground frame appears the same when it is turned: use one whose markers all have distances of their own");
  }
}

GroundFound fit(const std::vector<SpacePoint>& points, const std::vector<std::size_t>& match, std::span<const Vector<3>> frame,
                bool free_scale) {
  Eigen::Matrix3Xd world(3, frame.size()), ground(3, frame.size());
  for (std::size_t m = 0; m < frame.size(); ++m) {
    world.col(static_cast<Eigen::Index>(m)) = points[match[m]].location;
    ground.col(static_cast<Eigen::Index>(m)) = frame[m];
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(world, ground, free_scale);
  GroundFound found;
  found.scale = std::cbrt(motion.topLeftCorner<3, 3>().determinant());
  found.ground_from_world = {motion.topLeftCorner<3, 3>() / found.scale, motion.topRightCorner<3, 1>() / found.scale};
  const Eigen::Matrix3Xd off =
      ((motion.topLeftCorner<3, 3>() * world).colwise() + Vector<3>(motion.topRightCorner<3, 1>())) - ground;
  found.rms_mm = 1000 * std::sqrt(off.squaredNorm() / static_cast<double>(frame.size()));
  for (const std::size_t p : match) found.observed_by.push_back(static_cast<int>(points[p].detected.size()));
  return found;
}

}  // namespace

std::vector<Vector<2>> still_blobs(std::span<const wand::BlobFrame> frames) {
  struct Location {
    Vector<2> sum = Vector<2>::Zero();
    std::size_t count = 0;
    Vector<2> mean() const { return sum / static_cast<double>(count); }
  };
  std::vector<Location> locations;
  for (const wand::BlobFrame& frame : frames) {
    for (const auto& blob : frame.blobs) {
      auto location = std::find_if(locations.begin(), locations.end(),
                                   [&](const Location& one) { return (one.mean() - blob).norm() < kSamePosition; });
      if (location == locations.end()) location = locations.insert(locations.end(), Location{});
      location->sum += blob;
      ++location->count;
    }
  }
  std::vector<Vector<2>> still;
  for (const Location& location : locations) {
    if (2 * location.count >= frames.size()) still.push_back(location.mean());
  }
  return still;
}

GroundFound find_ground(const Rig& rig, std::span<const std::vector<Vector<2>>> blobs, std::span<const Vector<3>> frame,
                        bool free_scale) {
  check_frame(frame, free_scale);
  const auto views = views_of(rig, blobs);
  if (views.size() < 2)
    throw Error("{} of the rig's cameras have a lens and a pose; the ground needs two: calibrate them first", views.size());
  const auto points = points_in_space(views);
  std::vector<Vector<3>> locations;
  for (const SpacePoint& point : points) locations.push_back(point.location);
  std::optional<GroundFound> best;
  const Matcher matcher(locations, frame, free_scale);
  for (const auto& match : matcher.matches()) {
    const GroundFound found = fit(points, match, frame, free_scale);
    if (!best || found.rms_mm < best->rms_mm) best = found;
  }
  if (best) return *best;
  throw Error(
      "the ground frame is not found: {} points stand still where rays meet, and no {} of them have its distances; lay it where "
      "two cameras "
      "or more see all of it, cover what else shines, and check --l-frame",
      points.size(), frame.size());
}

GroundFound ground_under_board(std::span<const Rigid3> world_from_board) {
  // A board's z runs away from the viewer: into the floor.
  const Rigid3 board_from_ground{Vector<3>(1, -1, -1).asDiagonal(), Vector<3>::Zero()};
  const auto count = static_cast<double>(world_from_board.size());
  Matrix<3> turn = Matrix<3>::Zero();
  Vector<3> origin = Vector<3>::Zero();
  for (const Rigid3& one : world_from_board) {
    const Rigid3 world_from_ground = one * board_from_ground;
    turn += world_from_ground.rotation;
    origin += world_from_ground.translation / count;
  }
  const geometry::SingularValues3 svd = geometry::singular_values(turn);
  GroundFound ground;
  ground.ground_from_world = Rigid3{svd.U * svd.V.transpose(), origin}.inverse();
  double square = 0;
  for (const Rigid3& one : world_from_board) square += ((one * board_from_ground).translation - origin).squaredNorm();
  ground.rms_mm = 1000 * std::sqrt(square / count);
  ground.observed_by = {static_cast<int>(world_from_board.size())};
  if (ground.rms_mm <= 1000 * kBoardsOff_m) return ground;
  throw Error("the cameras place the board {:.0f} mm apart: it was moved between their images, or the rig is not of these cameras",
              ground.rms_mm);
}

Rig moved_to_ground(const Rig& rig, const Rigid3& ground_from_world, double scale) {
  Rig moved = rig;
  moved.ground = {};  // of another world
  for (RigCamera& camera : moved.cameras) {
    if (!camera.camera_from_world) continue;
    const Vector<3> centre = scale * (ground_from_world * camera.camera_from_world->inverse().translation);
    const Matrix<3> rotation = camera.camera_from_world->rotation * ground_from_world.rotation.transpose();
    camera.camera_from_world = Rigid3{rotation, -rotation * centre};
  }
  return moved;
}

}  // namespace marey::calibrate
