#include "marey/calibrate/pitch/pitch_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <ceres/ceres.h>

#include "marey/calibrate/pitch/pitch_residual.h"
#include "marey/calibrate/pitch/pitch_start.h"
#include "marey/calibrate/solve.h"
#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::pitch {
namespace {

void check(const std::string& name, const std::vector<PitchPoint>& points) {
  if (points.size() < 4)
    throw Error("{}: {} {} on the pitch {} given; at least 4 are needed, not all on one line", name, points.size(),
                points.size() == 1 ? "point" : "points", points.size() == 1 ? "is" : "are");
  for (const bool in_image : {false, true}) {
    Vector<2> middle = Vector<2>::Zero();
    for (const PitchPoint& point : points) middle += in_image ? point.pixel : point.ground;
    middle /= static_cast<double>(points.size());
    Matrix<2> spread = Matrix<2>::Zero();
    for (const PitchPoint& point : points) {
      const Vector<2> off = (in_image ? point.pixel : point.ground) - middle;
      spread += off * off.transpose();
    }
    // The eigenvalues of a 2 x 2 matrix, by hand: Eigen's solver costs the compiler seconds.
    const double half_trace = 0.5 * spread.trace();
    const double half_gap = std::hypot(0.5 * (spread(0, 0) - spread(1, 1)), spread(0, 1));
    const double across = half_trace - half_gap, along = half_trace + half_gap;
    if (across < 1e-5 * along || !(along > 0))
      throw Error("{}: all {} points lie on one line {}; click points on at least two lines of the pitch", name, points.size(),
                  in_image ? "of the image" : "of the pitch");
  }
}

// --- Lens and pose together ----------------------------------------------------------------------------------------------

struct PointError {
  PitchPoint point;
  double sigma;

  template <typename T>
  bool operator()(const T* p, T* error) const {
    const Eigen::Matrix<T, 2, 1> pixel = project_ground(p, point.ground, T(0));
    error[0] = (pixel.x() - point.pixel.x()) / sigma;
    error[1] = (pixel.y() - point.pixel.y()) / sigma;
    return true;
  }
};

struct LineError {
  LineSighting detected;
  double sigma;

  template <typename T>
  bool operator()(const T* p, T* error) const {
    const Eigen::Matrix<T, 2, 1> pixel = project_ground(p, detected.ground, T(0));
    error[0] =
        ((pixel.x() - detected.pixel.x()) * detected.normal.x() + (pixel.y() - detected.pixel.y()) * detected.normal.y()) / sigma;
    return true;
  }
};

LensPrior prior_of(cv::Size size, bool free_lens) {
  LensPrior prior;
  prior.middle.p[CameraNumbers::principal] = middle_of(size).x();
  prior.middle.p[CameraNumbers::principal + 1] = middle_of(size).y();
  const double off_centre = (free_lens ? 0.05 : 0.02) * size.width;
  prior.sigma.p[CameraNumbers::principal] = prior.sigma.p[CameraNumbers::principal + 1] = off_centre;
  const double tangential = free_lens ? 0.02 : 0.002;
  const double rational = free_lens ? 0.3 : 0;
  const std::array<double, 8> distortion = {0.5, 0.5, tangential, tangential, 0.3, rational, rational, rational};
  std::copy(distortion.begin(), distortion.end(), prior.sigma.p.begin() + CameraNumbers::distortion);
  return prior;
}

constexpr double kClickSigmaAlone = 3;       // px: how well people click
constexpr double kClickSigmaWithLines = 15;  // px: where lines are seen, clicks only keep the whole in place
constexpr double kPaintSigmaMetres = 0.04;   // m: how well it was laid, and how level the ground is

double solve(CameraNumbers& numbers, cv::Size size, const std::vector<PitchPoint>& points, const std::vector<char>& inlier,
             const std::vector<LineSighting>& sightings, bool free_lens) {
  ceres::Problem problem;
  const double click = sightings.empty() ? kClickSigmaAlone : kClickSigmaWithLines;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!inlier[i]) continue;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointError, 2, CameraNumbers::count>(new PointError{points[i], click}),
                             new ceres::SoftLOneLoss(1), numbers.p.data());
  }
  for (const LineSighting& detected : sightings) {
    const double sigma = std::hypot(detected.sigma_px, kPaintSigmaMetres * detected.pixels_per_metre);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LineError, 1, CameraNumbers::count>(new LineError{detected, sigma}),
                             new ceres::CauchyLoss(1), numbers.p.data());
  }
  const LensPrior prior = prior_of(size, free_lens);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<LensPrior, CameraNumbers::rotation - CameraNumbers::principal, CameraNumbers::count>(
          new LensPrior(prior)),
      nullptr, numbers.p.data());
  std::vector<int> held;
  for (int i = CameraNumbers::principal; i < CameraNumbers::rotation; ++i) {
    if (prior.sigma.p[i] == 0) held.push_back(i);
  }
  if (!held.empty()) problem.SetManifold(numbers.p.data(), new ceres::SubsetManifold(CameraNumbers::count, held));
  problem.SetParameterLowerBound(numbers.p.data(), CameraNumbers::focal, 0.1 * size.width);
  problem.SetParameterUpperBound(numbers.p.data(), CameraNumbers::focal, 100.0 * size.width);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  const ceres::Solver::Summary summary = calibrate::solve(options, problem);
  return summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
}

/// Focal lengths, in half image widths, for which the homography's columns are those of a rotation; typical ones besides.
std::vector<double> focal_candidates(const Matrix<3>& H) {
  const Vector<3> a = H.col(0), b = H.col(1);
  std::vector<double> result = {0.8, 1.4, 2.5, 5};
  for (const double square : {-(a.x() * b.x() + a.y() * b.y()) / (a.z() * b.z()),
                              -(a.head<2>().squaredNorm() - b.head<2>().squaredNorm()) / (a.z() * a.z() - b.z() * b.z())}) {
    if (std::isfinite(square) && square > 0.05 && square < 1e4) result.push_back(std::sqrt(square));
  }
  return result;
}

Camera camera_at(const PitchStart& start, double focal, cv::Size size) {
  Matrix<3> M = Vector<3>(1 / focal, 1 / focal, 1).asDiagonal() * start.image_from_ground;
  M /= std::sqrt(M.col(0).norm() * M.col(1).norm());
  Matrix<3> columns;
  columns << M.col(0), M.col(1), M.col(0).cross(M.col(1));
  const geometry::SingularValues3 svd = geometry::singular_values(columns);
  const Matrix<3> rotation = svd.U * svd.V.transpose();
  const double pixels = focal * size.width / 2;
  // The division model bends by 1 + λ r² where Brown's bends by 1 + k r²: to first order k = λ f².
  return {geometry::BrownLens{{pixels, pixels}, middle_of(size), {start.strength * focal * focal}}, {rotation, M.col(2)}, size};
}

std::vector<double> errors_of(const Camera& camera, const std::vector<PitchPoint>& points) {
  std::vector<double> errors;
  for (const PitchPoint& point : points) {
    const auto pixel = camera.project({point.ground.x(), point.ground.y(), 0});
    errors.push_back(pixel ? (*pixel - point.pixel).norm() : std::numeric_limits<double>::infinity());
  }
  return errors;
}

constexpr double kWorstMedian = 0.02;  // of the image's width: points that half lie farther off are of no camera
constexpr double kMinOutlier = 6;      // px: no user clicks better than this always
constexpr double kOutlierSigmas = 4;

/// Whether it is above the ground and sees most of these points at all: a camera under it that sees them mirrored, one that faces
/// away, or a lens that folds over may fit them in the formulas.
bool faces_ground(const Camera& camera, const std::vector<PitchPoint>& points, const std::vector<char>& which) {
  if (!(camera.camera_from_world().inverse().translation.z() > 0)) return false;
  std::ptrdiff_t detected = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    detected += which[i] && camera.project({points[i].ground.x(), points[i].ground.y(), 0}) ? 1 : 0;
  return 2 * detected > std::count(which.begin(), which.end(), 1);
}

/// The best that a start leads to; nothing if none faces down upon the points.
std::optional<CameraNumbers> camera_from(const PitchStart& start, const std::vector<PitchPoint>& points, cv::Size size) {
  const std::vector<char> agree = start.agreeing(points, size);
  double best = std::numeric_limits<double>::infinity();
  std::optional<CameraNumbers> found;
  for (const double focal : focal_candidates(start.image_from_ground)) {
    CameraNumbers p = CameraNumbers::of(camera_at(start, focal, size));
    const double cost = solve(p, size, points, agree, {}, false);
    if (cost < best && faces_ground(p.camera(size), points, agree)) best = cost, found = p;
  }
  return found;
}

std::vector<char> inliers_of(const std::vector<double>& errors) {
  const double reach = std::max(kMinOutlier, kOutlierSigmas * 1.2 * geometry::median(std::vector(errors)));
  std::vector<char> inlier;
  for (const double error : errors) inlier.push_back(error < reach);
  return inlier;
}

constexpr double kDistinctlyWorse = 3;  // times what the other hand's map costs: cameras need not be tried

std::vector<PitchPoint> mirrored(std::vector<PitchPoint> points) {
  for (PitchPoint& point : points) point.ground.y() = -point.ground.y();
  return points;
}

/// px in the mean, no more than an outlier's each, of the best camera that faces down upon the points; infinite where none does.
double misfit(const std::string& name, const std::vector<PitchPoint>& points, cv::Size size) {
  try {
    const PitchCamera found = camera_from_points(name, points, size);
    double sum = 0;
    for (const double error : found.error_px) sum += std::min(error, kMinOutlier);
    return sum / static_cast<double>(points.size());
  } catch (const Error&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

CameraNumbers CameraNumbers::of(const Camera& camera) {
  const auto& lens = std::get<geometry::BrownLens>(camera.lens());
  CameraNumbers numbers;
  numbers.p[focal] = lens.focal.x();
  numbers.p[principal] = lens.principal.x();
  numbers.p[principal + 1] = lens.principal.y();
  std::copy(lens.distortion.begin(), lens.distortion.end(), numbers.p.begin() + distortion);
  const Vector<3> turn = geometry::angle_axis_of(camera.camera_from_world().rotation);
  std::copy_n(turn.data(), 3, numbers.p.begin() + rotation);
  std::copy_n(camera.camera_from_world().translation.data(), 3, numbers.p.begin() + translation);
  return numbers;
}

Camera CameraNumbers::camera(cv::Size size) const {
  geometry::BrownLens lens{{p[focal], p[focal]}, {p[principal], p[principal + 1]}, {}};
  std::copy_n(p.begin() + distortion, 8, lens.distortion.begin());
  return {lens,
          {geometry::rotation_from({p[rotation], p[rotation + 1], p[rotation + 2]}),
           {p[translation], p[translation + 1], p[translation + 2]}},
          size};
}

bool is_left_handed(const std::string& name, const std::vector<PitchPoint>& points, cv::Size size) {
  check(name, points);
  const PitchStarts starts = find_pitch_starts(points, size);
  const double right = PitchStarts::cost(starts.right), left = PitchStarts::cost(starts.left);
  if (!std::isfinite(std::min(left, right)))
    throw Error("{}: the points do not fit any camera; are four of them in general position, and is each with its place?", name);
  if (std::max(left, right) > kDistinctlyWorse * std::min(left, right)) return left < right;
  const double by_right = misfit(name, points, size), by_left = misfit(name, mirrored(points), size);
  return by_left == by_right ? left < right : by_left < by_right;
}

PitchCamera camera_from_points(const std::string& name, const std::vector<PitchPoint>& points, cv::Size size) {
  check(name, points);
  const std::vector<PitchStart> starts = find_pitch_starts(points, size).right;
  if (starts.empty()) throw Error("{}: the points do not fit any camera; is each with its place on the pitch?", name);
  std::optional<CameraNumbers> first;
  for (const PitchStart& start : starts) {
    first = camera_from(start, points, size);
    if (first) break;
  }
  if (!first) throw Error("{}: no camera over a level pitch fits the points; is each with its place on it?", name);
  CameraNumbers numbers = *first;
  std::vector<char> agree;
  for (int round = 0; round < 4; ++round) {
    agree = inliers_of(errors_of(numbers.camera(size), points));
    solve(numbers, size, points, agree, {}, false);
  }
  PitchCamera result{numbers.camera(size), {}, {}};
  result.error_px = errors_of(result.camera, points);
  result.inlier = inliers_of(result.error_px);
  const double middle = geometry::median(std::vector(result.error_px));
  if (middle > kWorstMedian * size.width)
    throw Error("{}: no camera sees half of the {} points within {:.0f} px of their clicks; most are clicked or named wrong", name,
                points.size(), middle);
  const auto good = std::count(result.inlier.begin(), result.inlier.end(), 1);
  if (good < 4 || 2 * good <= static_cast<std::ptrdiff_t>(points.size()))
    throw Error("{}: only {} of {} points agree on one camera; most are clicked or named wrong, or left and right are exchanged",
                name, good, points.size());
  return result;
}

Camera refine(const Camera& start, const std::vector<PitchPoint>& points, const std::vector<char>& inlier,
              const std::vector<LineSighting>& sightings, bool free_lens) {
  CameraNumbers numbers = CameraNumbers::of(start);
  solve(numbers, start.size(), points, inlier, sightings, free_lens);
  return numbers.camera(start.size());
}

}  // namespace marey::calibrate::pitch
