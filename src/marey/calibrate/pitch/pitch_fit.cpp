#include "marey/calibrate/pitch/pitch_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <ceres/ceres.h>

#include "marey/calibrate/solve.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/ground_view.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::pitch {
namespace {

using geometry::GroundSurface;

// What clicks and paint usually err by (bench/tuning.md): of both, how much is learned from the recording.
constexpr double kClickPixels = 2, kClickMetres = 0.05;
constexpr double kPaintPixels = 0.3, kPaintMetres = 0.02;
constexpr double kMinScale = 0.2;  // of what is typical: no person clicks, and no codec leaves paint, better
constexpr double kFreedom = 3;     // degrees of freedom of Student's t
constexpr double kPiece = 2;       // m of paint that make one residual
constexpr double kMinNews = 0.2;   // of the pieces of paint
constexpr int kMaxAlike = 6;       // pieces apart that may still err alike
constexpr double kWide = 5;        // the first solution's scale: it begins far off
constexpr double kDefaultHeight = 0.3, kOffCentre = 0.03;  // deviations beforehand: m; of the image's width

constexpr int kGroundTerms = GroundSurface::kTerms, kCameraNumbers = CameraNumbers::count;
constexpr std::array<int, 4> kLenses = {2, 3, 5, 8};                 // coefficients in the order of kLensOrder
constexpr std::array<int, 8> kLensOrder = {0, 1, 4, 2, 3, 5, 6, 7};  // k1 k2 k3, p1 p2, k4 k5 k6
using Free = std::array<bool, kGroundTerms>;
constexpr std::array<Free, 9> kGrounds = {{{},
                                           {true, false, false, false},
                                           {false, true, false, false},
                                           {false, false, true, false},
                                           {true, true, false, false},
                                           {true, false, false, true},
                                           {false, false, true, true},
                                           {true, true, true, false},
                                           {true, true, true, true}}};

/// A place of the ground seen in an image.
struct ObservedPosition {
  Vector<2> ground, relative, pixel;
  Matrix<2> whiten;  ///< of a piece of paint only the first row counts: across it
  int line = -1;
};

struct ObservedPitch {
  cv::Size size;
  std::vector<ObservedPosition> clicks, painted, clicked_lines;
};

/// By how much errors differ from what is typical, and which share of the pieces of paint is news.
struct Noise {
  double click = 1, paint = 1, news = 1;
};

/// What is solved for.
struct PitchState {
  std::vector<CameraNumbers> cameras;
  std::array<double, kGroundTerms> ground{};
};

/// Which of it is free, and the result.
struct PitchModel {
  int lens = kLenses.back();
  Free ground{};
  PitchState state;
  double criterion = std::numeric_limits<double>::infinity();
};

template <int kErrors>
struct PositionError {
  ObservedPosition detected;
  double scale;

  template <typename T>
  bool operator()(const T* p, const T* ground, T* error) const {
    const Eigen::Matrix<T, 2, 1> pixel = project_ground(p, detected.ground, GroundSurface::height_at(detected.relative, ground));
    const T x = pixel.x() - detected.pixel.x(), y = pixel.y() - detected.pixel.y();
    for (int i = 0; i < kErrors; ++i) error[i] = (detected.whiten(i, 0) * x + detected.whiten(i, 1) * y) / scale;
    return true;
  }
};

struct HeightPrior {
  template <typename T>
  bool operator()(const T* ground, T* error) const {
    for (int i = 0; i < 3; ++i) error[i] = ground[i] / kDefaultHeight;
    return true;
  }
};

/// What takes a click's error in px to its share of what clicks usually err by.
Matrix<2> whitener(const GroundView& view, const Vector<2>& ground) {
  Matrix<2> covariance = kClickPixels * kClickPixels * Matrix<2>::Identity();
  const auto pixel = view.pixel(ground);
  if (const auto location = pixel ? view.location(*pixel) : std::nullopt) {
    const Matrix<2> by_ground = location->by_pixel.inverse();
    covariance += kClickMetres * kClickMetres * by_ground * by_ground.transpose();
  }
  return Matrix<2>(covariance.llt().matrixL()).inverse();
}

ObservedPosition across_line(const Vector<2>& ground, const Vector<2>& relative, const LineSighting& detected,
                             const Vector<2>& pixel, double sigma) {
  ObservedPosition location{ground, relative, pixel, Matrix<2>::Zero(), detected.line};
  location.whiten.row(0) = detected.normal.transpose() / sigma;
  return location;
}

/// The paint, piece by piece: where in the middle of each it is seen, by the median of how far its places lie off.
std::vector<ObservedPosition> pieces_of(const std::vector<LineSighting>& painted, const GroundView& view) {
  std::vector<ObservedPosition> pieces;
  for (std::size_t begin = 0, end = 0; begin < painted.size(); begin = end) {
    std::vector<double> off;
    for (end = begin; end < painted.size() && painted[end].line == painted[begin].line &&
                      (painted[end].ground - painted[begin].ground).norm() < kPiece;
         ++end) {
      if (const auto here = view.pixel(painted[end].ground)) off.push_back(painted[end].normal.dot(painted[end].pixel - *here));
    }
    const LineSighting& middle = painted[(begin + end - 1) / 2];
    const auto expected = view.pixel(middle.ground);
    if (off.empty() || !expected) continue;
    pieces.push_back(across_line(middle.ground, view.surface().relative(middle.ground), middle,
                                 *expected + geometry::median(off) * middle.normal,
                                 std::hypot(kPaintPixels, kPaintMetres * middle.pixels_per_metre)));
  }
  return pieces;
}

ObservedPitch observed_in(const PitchEvidence& evidence, const GroundSurface& ground) {
  const GroundView view(evidence.initial, ground);
  ObservedPitch detected{evidence.initial.size(), {}, pieces_of(evidence.painted, view), {}};
  for (const PitchPoint& point : evidence.points)
    detected.clicks.push_back({point.ground, ground.relative(point.ground), point.pixel, whitener(view, point.ground), -1});
  for (const LineSighting& line : evidence.clicked)
    detected.clicked_lines.push_back(across_line(line.ground, ground.relative(line.ground), line, line.pixel, line.sigma_px));
  return detected;
}

ceres::LossFunction* student(double weight) {
  return new ceres::ScaledLoss(new ceres::CauchyLoss(std::sqrt(kFreedom)), weight * (kFreedom + 1) / kFreedom,
                               ceres::TAKE_OWNERSHIP);
}

template <int kErrors>
void add_positions(ceres::Problem& problem, const std::vector<ObservedPosition>& locations, double scale, double weight,
                   double* camera, double* ground) {
  using Error = PositionError<kErrors>;
  for (const ObservedPosition& location : locations)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Error, kErrors, kCameraNumbers, kGroundTerms>(new Error{location, scale}), student(weight),
        camera, ground);
}

LensPrior prior_over(cv::Size size) {
  LensPrior prior;
  prior.middle.p[CameraNumbers::principal] = middle_of(size).x();
  prior.middle.p[CameraNumbers::principal + 1] = middle_of(size).y();
  prior.sigma.p[CameraNumbers::principal] = prior.sigma.p[CameraNumbers::principal + 1] = kOffCentre * size.width;
  const std::array<double, 8> distortion = {0.5, 0.5, 0.01, 0.01, 0.3, 0.3, 0.3, 0.3};
  std::copy(distortion.begin(), distortion.end(), prior.sigma.p.begin() + CameraNumbers::distortion);
  return prior;
}

void hold(ceres::Problem& problem, double* block, int size, const std::vector<int>& held) {
  if (std::ssize(held) == size)
    problem.SetParameterBlockConstant(block);
  else if (!held.empty())
    problem.SetManifold(block, new ceres::SubsetManifold(size, held));
}

std::vector<int> held_of(int lens) {
  std::vector<int> held;
  for (std::size_t i = static_cast<std::size_t>(lens); i < kLensOrder.size(); ++i)
    held.push_back(CameraNumbers::distortion + kLensOrder[i]);
  return held;
}

std::vector<int> held_of(const Free& ground) {
  std::vector<int> held;
  for (int i = 0; i < kGroundTerms; ++i) {
    if (!ground[static_cast<std::size_t>(i)]) held.push_back(i);
  }
  return held;
}

/// The problem of a candidate, over its state; `scale` widens all errors.
void set_up(ceres::Problem& problem, const std::vector<ObservedPitch>& detected, PitchModel& candidate, const Noise& noise,
            double scale) {
  double* ground = candidate.state.ground.data();
  for (std::size_t i = 0; i < detected.size(); ++i) {
    double* camera = candidate.state.cameras[i].p.data();
    add_positions<2>(problem, detected[i].clicks, scale * noise.click, 1, camera, ground);
    add_positions<1>(problem, detected[i].painted, scale * noise.paint, noise.news, camera, ground);
    add_positions<1>(problem, detected[i].clicked_lines, scale, 1, camera, ground);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LensPrior, CameraNumbers::rotation - CameraNumbers::principal, kCameraNumbers>(
            new LensPrior(prior_over(detected[i].size))),
        nullptr, camera);
    hold(problem, camera, kCameraNumbers, held_of(candidate.lens));
    problem.SetParameterLowerBound(camera, CameraNumbers::focal, 0.1 * detected[i].size.width);
    problem.SetParameterUpperBound(camera, CameraNumbers::focal, 100.0 * detected[i].size.width);
  }
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<HeightPrior, 3, kGroundTerms>(new HeightPrior), nullptr, ground);
  hold(problem, ground, kGroundTerms, held_of(candidate.ground));
  if (!candidate.ground[3]) return;
  problem.SetParameterLowerBound(ground, 3, 0);
  problem.SetParameterUpperBound(ground, 3, 1);
}

double news_in(const std::vector<ObservedPitch>& detected, const Noise& noise) {
  double count = 0;
  for (const ObservedPitch& one : detected) {
    count += 2 * static_cast<double>(one.clicks.size()) + noise.news * static_cast<double>(one.painted.size()) +
             static_cast<double>(one.clicked_lines.size());
  }
  return count;
}

double free_terms(const PitchModel& candidate) {
  return static_cast<double>(candidate.lens) * static_cast<double>(candidate.state.cameras.size()) +
         static_cast<double>(std::count(candidate.ground.begin(), candidate.ground.end(), true));
}

/// Solves a candidate from its state, and says what it is worth.
void settle(const std::vector<ObservedPitch>& detected, PitchModel& candidate, const Noise& noise) {
  for (CameraNumbers& camera : candidate.state.cameras) {
    for (const int held : held_of(candidate.lens)) camera.p[static_cast<std::size_t>(held)] = 0;
  }
  if (candidate.ground[3]) candidate.state.ground[3] = std::clamp(candidate.state.ground[3], 0.2, 0.8);
  for (const double scale : {kWide, 1.0}) {
    ceres::Problem problem;
    set_up(problem, detected, candidate, noise, scale);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-9;
    const ceres::Solver::Summary summary = calibrate::solve(options, problem);
    if (!summary.IsSolutionUsable()) return;
    candidate.criterion = 2 * summary.final_cost + free_terms(candidate) * std::log(std::max(2.0, news_in(detected, noise)));
  }
}

/// The first `count` errors of a place, whitened by what is typical.
Vector<2> error_of(const ObservedPosition& location, const PitchState& state, std::size_t camera) {
  const auto& p = state.cameras[camera].p;
  return location.whiten *
         (project_ground(p.data(), location.ground, GroundSurface::height_at(location.relative, state.ground.data())) -
          location.pixel);
}

/// The share of the pieces that is news: one over what the sum of a line's errors varies by, in what independent ones would.
double news_of(const std::vector<ObservedPitch>& detected, const PitchState& state) {
  std::array<double, kMaxAlike + 1> products{};
  for (std::size_t camera = 0; camera < detected.size(); ++camera) {
    const auto& pieces = detected[camera].painted;
    std::vector<double> errors;
    for (const ObservedPosition& piece : pieces) errors.push_back(std::clamp(error_of(piece, state, camera).x(), -3.0, 3.0));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t lag = 0; lag <= kMaxAlike && i + lag < pieces.size() && pieces[i + lag].line == pieces[i].line; ++lag)
        products[lag] += errors[i] * errors[i + lag];
    }
  }
  double alike = 1;
  for (std::size_t lag = 1; lag <= kMaxAlike && products[0] > 0; ++lag) alike += 2 * std::max(0.0, products[lag] / products[0]);
  return std::max(kMinNews, 1 / alike);
}

/// What the richest model leaves is noise.
Noise learned(const std::vector<ObservedPitch>& detected, const PitchModel& richest) {
  // Medians of |error| for a deviation of 1, in two dimensions and in one: by definition.
  constexpr double kOfPlane = 1.1774, kOfLine = 0.6745;
  std::vector<double> clicks, paint;
  for (std::size_t camera = 0; camera < detected.size(); ++camera) {
    for (const ObservedPosition& click : detected[camera].clicks) clicks.push_back(error_of(click, richest.state, camera).norm());
    for (const ObservedPosition& piece : detected[camera].painted)
      paint.push_back(std::abs(error_of(piece, richest.state, camera).x()));
  }
  Noise noise;
  const double count = news_in(detected, noise), numbers = free_terms(richest) + 9.0 * static_cast<double>(detected.size());
  if (count < 1.5 * numbers) return noise;  // too little to distinguish noise from what the model takes
  const double taken = std::sqrt(count / (count - numbers));
  if (!clicks.empty()) noise.click = std::max(kMinScale, taken * geometry::median(clicks) / kOfPlane);
  if (!paint.empty()) noise.paint = std::max(kMinScale, taken * geometry::median(paint) / kOfLine);
  noise.news = news_of(detected, richest.state);
  return noise;
}

/// The best of all lenses and grounds; each begins from what the one before it, or the level one, came to.
PitchModel chosen(const std::vector<ObservedPitch>& detected, const PitchState& start, const Noise& noise, GroundKnown known) {
  PitchModel best;
  PitchState level = start;
  if (known != GroundKnown::wholly) level.ground = {};
  for (const int lens : kLenses) {
    for (const Free& ground : kGrounds) {
      const bool any = std::find(ground.begin(), ground.end(), true) != ground.end();
      if (any && known != GroundKnown::nothing) continue;
      PitchModel candidate{.lens = lens, .ground = ground, .state = level};
      settle(detected, candidate, noise);
      if (!any && std::isfinite(candidate.criterion)) level = candidate.state;
      if (candidate.criterion < best.criterion) best = std::move(candidate);
    }
  }
  return best;
}

/// The inverse of the criterion's curvature at its least, with rows of 0 for what is held.
Eigen::MatrixXd covariance_of(const std::vector<ObservedPitch>& detected, PitchModel candidate, const Noise& noise) {
  ceres::Problem problem;
  set_up(problem, detected, candidate, noise, 1);
  std::vector<int> free;
  const int cameras = static_cast<int>(detected.size());
  ceres::Problem::EvaluateOptions order;
  for (int i = 0; i <= cameras; ++i) {
    const bool of_ground = i == cameras;
    const std::vector<int> held = of_ground ? held_of(candidate.ground) : held_of(candidate.lens);
    const int size = of_ground ? kGroundTerms : kCameraNumbers;
    for (int k = 0; k < size; ++k) {
      if (std::find(held.begin(), held.end(), k) == held.end()) free.push_back(i * kCameraNumbers + k);
    }
    double* block = of_ground ? candidate.state.ground.data() : candidate.state.cameras[static_cast<std::size_t>(i)].p.data();
    if (std::ssize(held) < size) order.parameter_blocks.push_back(block);
  }
  ceres::CRSMatrix sparse;
  problem.Evaluate(order, nullptr, nullptr, nullptr, &sparse);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int k = sparse.rows[static_cast<std::size_t>(row)]; k < sparse.rows[static_cast<std::size_t>(row) + 1]; ++k)
      jacobian(row, sparse.cols[static_cast<std::size_t>(k)]) = sparse.values[static_cast<std::size_t>(k)];
  }
  const Eigen::MatrixXd inverse =
      geometry::solve_symmetric(jacobian.transpose() * jacobian, Eigen::MatrixXd::Identity(jacobian.cols(), jacobian.cols()));
  const int all = cameras * kCameraNumbers + kGroundTerms;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(all, all);
  for (std::size_t i = 0; i < free.size(); ++i) {
    for (std::size_t k = 0; k < free.size(); ++k)
      covariance(free[i], free[k]) = inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
  }
  return covariance;
}

/// What was not paid for may be there all the same: how sure a candidate is, is asked with one more of the lenses, and with a
/// crown.
PitchModel unsure(PitchModel best, GroundKnown known) {
  const auto own = std::find(kLenses.begin(), kLenses.end(), best.lens);
  if (own + 1 != kLenses.end()) best.lens = *(own + 1);
  if (known == GroundKnown::nothing) best.ground[0] = best.ground[1] = best.ground[2] = true;
  return best;
}

}  // namespace

PitchFit fit_pitch(const std::vector<PitchEvidence>& evidence, const GroundSurface& ground, GroundKnown known) {
  std::vector<ObservedPitch> detected;
  PitchState start{{}, ground.terms()};
  for (const PitchEvidence& one : evidence) {
    detected.push_back(observed_in(one, ground));
    start.cameras.push_back(CameraNumbers::of(one.initial));
  }
  Noise noise;
  PitchModel richest{.lens = kLenses.back(), .ground = known == GroundKnown::nothing ? kGrounds.back() : Free{}, .state = start};
  for (int round = 0; round < 2; ++round) {
    settle(detected, richest, noise);
    noise = learned(detected, richest);
  }
  const PitchModel best = chosen(detected, start, noise, known);
  PitchFit fit;
  fit.lens_terms = best.lens;
  fit.click_scale = noise.click;
  fit.ground = ground;
  fit.ground.set_terms(best.state.ground);
  for (std::size_t i = 0; i < best.state.cameras.size(); ++i) fit.cameras.push_back(best.state.cameras[i].camera(detected[i].size));
  fit.covariance = covariance_of(detected, unsure(best, known), noise);
  return fit;
}

double click_error(const GroundView& view, const PitchPoint& point) {
  const auto pixel = view.pixel(point.ground);
  if (!pixel) return std::numeric_limits<double>::infinity();
  return (whitener(view, point.ground) * (*pixel - point.pixel)).norm();
}

}  // namespace marey::calibrate::pitch
