#include "marey/reconstruct/camera_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <span>

#include <Eigen/LU>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/reconstruct/sight_line.h"
#include "marey/reconstruct/triangulate.h"

namespace marey::reconstruct {
namespace {

// numerical: how finely the volume is divided.
constexpr int kSides = 8, kMaxAcross = 9, kMaxUp = 4;
// physical: the cosine from which a side is visible, 80° aside.
constexpr double kGrazing = 0.17;
// numerical: lets a first camera count, and bounds the exchanges, of which two or three are used.
constexpr double kPriorFraction = 0.1;  // of the diagonal
constexpr int kMaxRounds = 6;
// s, of the room's diagonal; of a point that is visible, and from one camera alone; of the volume's half extent. unswept
constexpr double kTargetFraction = 0.001;
constexpr double kViewCredit = 0.3, kFirstView = 0.6;
constexpr double kAimReach = 0.25;

/// A place of the volume, and the side from which it must be observed; no side for points that are seen from everywhere.
struct SidedPoint {
  Vector<3> location;
  std::optional<Vector<3>> side;
};

struct PointGrid {
  std::vector<Vector<3>> positions;
  int columns, rows, layers;
  std::vector<SidedPoint> points;  // of each place, one after the other
};

int steps_of(double length, double spacing, int most) {
  return std::clamp(static_cast<int>(std::lround(length / spacing)), 2, most);
}

PointGrid grid_of(const PlannedRoom& room) {
  const Vector<3> extent = room.volume.to - room.volume.from;
  const double spacing = std::max(extent.x(), extent.y()) / (kMaxAcross - 1);
  PointGrid grid{.positions = {},
                 .columns = steps_of(extent.x(), spacing, kMaxAcross),
                 .rows = steps_of(extent.y(), spacing, kMaxAcross),
                 .layers = steps_of(extent.z(), spacing, kMaxUp),
                 .points = {}};
  for (int k = 0; k < grid.layers; ++k) {
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const Vector<3> share((i + 0.5) / grid.columns, (j + 0.5) / grid.rows, (k + 0.5) / grid.layers);
        grid.positions.push_back(room.volume.from + share.cwiseProduct(extent));
        if (!room.facing) grid.points.push_back({grid.positions.back(), std::nullopt});
        for (int side = 0; room.facing && side < kSides; ++side) {
          const double angle = 2 * std::numbers::pi * side / kSides;
          grid.points.push_back({grid.positions.back(), Vector<3>(std::cos(angle), std::sin(angle), 0)});
        }
      }
    }
  }
  return grid;
}

/// Whether the segment from a to b passes through the box (slabs).
bool crosses(const RoomBox& box, const Vector<3>& a, const Vector<3>& b) {
  double enter = 0, leave = 1;
  for (int i = 0; i < 3; ++i) {
    const double along = b[i] - a[i];
    if (std::abs(along) < 1e-12) {
      if (a[i] < box.from[i] || a[i] > box.to[i]) return false;
      continue;
    }
    const double first = (box.from[i] - a[i]) / along, second = (box.to[i] - a[i]) / along;
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter < leave;
}

/// Without regard to the camera's image: what may be seen from a place.
bool in_sight(const PlannedRoom& room, const Vector<3>& from, const SidedPoint& point) {
  const Vector<3> way = from - point.location;
  const double distance = way.norm();
  if (distance < 0.05 || (room.farthest_m && distance > *room.farthest_m)) return false;
  if (point.side && point.side->dot(way) < kGrazing * distance) return false;
  return std::ranges::none_of(room.obstacles, [&](const RoomBox& box) { return crosses(box, from, point.location); });
}

std::optional<SightLine> observed_by(const geometry::Camera& camera, int number, const Vector<3>& location, double noise_px) {
  const auto pixel = camera.project(location);
  if (!pixel || !camera.in_image(*pixel)) return std::nullopt;
  return sight_line(camera, number, *pixel, noise_px);
}

/// What one camera says of a point: the inverse of its covariance's part, 1/m².
Matrix<3> information_of(const SightLine& line, const Vector<3>& location) {
  const Eigen::Matrix<double, 2, 3> J = line.across / (line.depth(location) * line.sigma);
  return J.transpose() * J;
}

std::optional<double> error_of(std::span<const SightLine> lines, const Vector<3>& location) {
  const auto found = Triangulator()(lines, location);
  const auto* const point = std::get_if<SpacePoint>(&found);
  if (point == nullptr) return std::nullopt;
  return std::sqrt(point->covariance.trace());
}

/// x right, y down, z ahead; upright.
Rigid3 aimed(const Vector<3>& from, const Vector<3>& at) {
  const Vector<3> ahead = (at - from).normalized();
  Vector<3> right = ahead.cross(Vector<3>::UnitZ());
  if (right.norm() < 1e-6) right = Vector<3>::UnitX();
  right.normalize();
  Matrix<3> rotation;
  rotation << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  return {rotation, -rotation * from};
}

geometry::BrownLens pinhole_of(const PlannedRoom& room) {
  geometry::BrownLens lens;
  const double focal = room.size.width / (2 * std::tan(room.field_of_view / 2));
  lens.focal = {focal, focal};
  lens.principal = {(room.size.width - 1) / 2.0, (room.size.height - 1) / 2.0};
  return lens;
}

/// A camera that might be.
struct CandidateCamera {
  std::size_t mount = 0;
  geometry::Camera camera;
  std::vector<std::pair<std::size_t, Matrix<3>>> observed;  // points, by number, and what it says of them
};

/// The directions in which a camera may be aimed: to the middle of the volume and to points round it.
std::vector<Vector<3>> aims_of(const RoomBox& volume) {
  const Vector<3> middle = (volume.from + volume.to) / 2, half = (volume.to - volume.from) / 2 * kAimReach;
  std::vector<Vector<3>> aims{middle};
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) aims.push_back(middle + half.cwiseProduct(Vector<3>(x, y, z)));
    }
  }
  return aims;
}

std::vector<CandidateCamera> candidates_of(const PlannedRoom& room, const PointGrid& grid) {
  std::vector<CandidateCamera> candidates;
  const geometry::BrownLens lens = pinhole_of(room);
  for (std::size_t mount = 0; mount < room.mounts.size(); ++mount) {
    for (const Vector<3>& aim : aims_of(room.volume)) {
      if ((aim - room.mounts[mount]).norm() < 0.1) continue;
      candidates.push_back({mount, geometry::Camera(lens, aimed(room.mounts[mount], aim), room.size), {}});
    }
  }
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    CandidateCamera& candidate = candidates[i];
    for (std::size_t p = 0; p < grid.points.size(); ++p) {
      if (!in_sight(room, candidate.camera.centre(), grid.points[p])) continue;
      const auto line = observed_by(candidate.camera, 0, grid.points[p].location, room.noise_px);
      if (line) candidate.observed.emplace_back(p, information_of(*line, grid.points[p].location));
    }
  });
  return candidates;
}

/// The set that is being put together.
class CameraSelection {
 public:
  CameraSelection(const PlannedRoom& room, const PointGrid& grid, std::vector<CandidateCamera> candidates)
      : room_(room), candidates_(std::move(candidates)) {
    const double diagonal = (room.volume.to - room.volume.from).norm();
    target_ = std::pow(kTargetFraction * diagonal, 2);
    views_.assign(grid.points.size(), 0);
    information_.assign(grid.points.size(), Matrix<3>::Identity() / std::pow(kPriorFraction * diagonal, 2));
    values_.assign(grid.points.size(), value(information_.front(), 0));
  }

  std::vector<std::size_t> solve() {
    for (int i = 0; i < room_.cameras; ++i) {
      stop_point();
      take(best());
    }
    credit_ = 0;
    for (std::size_t p = 0; p < values_.size(); ++p) values_[p] = value(information_[p], views_[p]);
    for (int round = 0; round < kMaxRounds; ++round) {
      bool changed = false;
      for (std::size_t i = 0; i < taken_.size(); ++i) {
        stop_point();
        const std::size_t before = taken_[i];
        add(before, -1);
        taken_.erase(taken_.begin() + static_cast<std::ptrdiff_t>(i));
        const std::size_t now = best();
        taken_.insert(taken_.begin() + static_cast<std::ptrdiff_t>(i), now);
        add(now, 1);
        changed = changed || now != before;
      }
      if (!changed) break;
    }
    return taken_;
  }

  const std::vector<CandidateCamera>& candidates() const { return candidates_; }

 private:
  /// While cameras are added, one that sees a point alone has a part of what the second one brings: else no pair would ever begin
  /// behind a wall.
  double value(const Matrix<3>& information, int views) const {
    const double credit = views == 0 ? 0 : views == 1 ? kFirstView : 1;
    return target_ / (target_ + information.inverse().trace()) + credit_ * credit;
  }

  double gain(const CandidateCamera& candidate) const {
    double sum = 0;
    for (const auto& [point, observed] : candidate.observed)
      sum += value(information_[point] + observed, views_[point] + 1) - values_[point];
    return sum;
  }

  std::size_t best() const {
    std::vector<double> gains(candidates_.size(), -1);
    std::set<std::size_t> used;
    for (const std::size_t one : taken_) used.insert(candidates_[one].mount);
    const bool all_used = used.size() >= room_.mounts.size();
    tbb::parallel_for(std::size_t{0}, candidates_.size(), [&](std::size_t i) {
      if (all_used || !used.contains(candidates_[i].mount)) gains[i] = gain(candidates_[i]);
    });
    return static_cast<std::size_t>(std::max_element(gains.begin(), gains.end()) - gains.begin());
  }

  void add(std::size_t candidate, int sign) {
    for (const auto& [point, observed] : candidates_[candidate].observed) {
      information_[point] += sign * observed;
      views_[point] += sign;
      values_[point] = value(information_[point], views_[point]);
    }
  }

  void take(std::size_t candidate) {
    add(candidate, 1);
    taken_.push_back(candidate);
  }

  const PlannedRoom& room_;
  std::vector<CandidateCamera> candidates_;
  double target_ = 1, credit_ = kViewCredit;
  std::vector<int> views_;  // cameras that see each point
  std::vector<Matrix<3>> information_;
  std::vector<double> values_;
  std::vector<std::size_t> taken_;
};

double quantile_of(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

std::optional<double> expected_error(const Vector<3>& location, const std::vector<geometry::Camera>& cameras, double noise_px) {
  std::vector<SightLine> lines;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (const auto line = observed_by(cameras[i], static_cast<int>(i), location, noise_px)) lines.push_back(*line);
  }
  return lines.size() < 2 ? std::nullopt : error_of(lines, location);
}

RoomCoverage coverage_of(const PlannedRoom& room, const std::vector<geometry::Camera>& cameras) {
  const PointGrid grid = grid_of(room);
  RoomCoverage coverage{.points = {}, .columns = grid.columns, .rows = grid.rows, .layers = grid.layers};
  std::vector<double> errors;
  std::vector<SightLine> lines;
  const std::size_t sides = grid.points.size() / grid.positions.size();
  for (std::size_t place = 0; place < grid.positions.size(); ++place) {
    PlannedPoint& point = coverage.points.emplace_back();
    point.location = grid.positions[place];
    double squares = 0;
    int covered = 0;
    for (std::size_t side = 0; side < sides; ++side) {
      const SidedPoint& sided = grid.points[place * sides + side];
      lines.clear();
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        if (!in_sight(room, cameras[i].centre(), sided)) continue;
        if (const auto line = observed_by(cameras[i], static_cast<int>(i), sided.location, room.noise_px)) lines.push_back(*line);
      }
      const auto error = lines.size() < 2 ? std::nullopt : error_of(lines, sided.location);
      if (!error) continue;
      ++covered;
      squares += *error * *error;
      errors.push_back(*error);
    }
    point.covered = static_cast<double>(covered) / static_cast<double>(sides);
    point.error_m = covered == 0 ? 0 : std::sqrt(squares / covered);
  }
  coverage.covered = static_cast<double>(errors.size()) / static_cast<double>(grid.points.size());
  coverage.p95_m = quantile_of(errors, 0.95);
  coverage.median_m = quantile_of(errors, 0.5);
  return coverage;
}

Rig plan_cameras(const PlannedRoom& room) {
  const PointGrid grid = grid_of(room);
  std::vector<CandidateCamera> candidates = candidates_of(room, grid);
  if (std::ranges::all_of(candidates, [](const CandidateCamera& one) { return one.observed.empty(); }))
    throw Error("{}", "no camera at any of the mounts sees the volume: obstacles, `farthest`, or mounts inside it hide it all");
  CameraSelection selection(room, grid, std::move(candidates));
  Rig rig;
  for (const std::size_t chosen : selection.solve()) {
    const geometry::Camera& camera = selection.candidates()[chosen].camera;
    RigCamera& one = rig.cameras.emplace_back();
    one.name = fmt::format("cam{}", rig.cameras.size());
    one.size = room.size;
    one.lens = camera.lens();
    one.camera_from_world = camera.camera_from_world();
  }
  rig.calibration = Rig::Calibration{
      .method = "planned: not measured", .mean_px = {}, .rms_px = {}, .inliers = {}, .observations = {}, .grade = {}};
  return rig;
}

}  // namespace marey::reconstruct
