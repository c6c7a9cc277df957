#include "marey/calibrate/ptz/tripod_solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <ceres/ceres.h>

#include "marey/calibrate/solve.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::ptz {
namespace {

constexpr int kStill = geometry::Tripod::numbers;
constexpr int kStarts = 6;              // guesses that are refined
constexpr double kWorstMedian = 0.012;  // of the image's width: clicks that half lie farther off are of no camera
constexpr double kOtherHand = 0.5;      // a left-handed frame of clicks leaves less than this of a right-handed one's cost; unswept
constexpr double kOtherHalf = 0.35;  // a frame's clicks belong to the other half where that leaves less than this of the distance
constexpr double kMinLevel = 1.5;    // m: no camera of a match stands lower

template <typename T>
Eigen::Matrix<T, 2, 1> pixel_of(const T* still, const T* ptz, const Vector<2>& ground, cv::Size size) {
  const geometry::TripodFrame<T> frame(still, ptz);
  const Eigen::Matrix<T, 2, 1> detected = frame.detected(Eigen::Matrix<T, 3, 1>(T(ground.x()), T(ground.y()), T(0)));
  return {T((size.width - 1) / 2.0) + detected.x() * T(size.width / 2.0),
          T((size.height - 1) / 2.0) + detected.y() * T(size.width / 2.0)};
}

struct ClickOff {
  ClickedPosition click;
  cv::Size size;
  double sigma;

  template <typename T>
  bool operator()(const T* still, const T* ptz, T* off) const {
    const auto pixel = pixel_of(still, ptz, click.ground, size);
    off[0] = (pixel.x() - T(click.pixel.x())) / T(sigma);
    off[1] = (pixel.y() - T(click.pixel.y())) / T(sigma);
    return true;
  }
};

struct PaintOff {
  PaintSighting detected;
  cv::Size size;

  template <typename T>
  bool operator()(const T* still, const T* ptz, T* off) const {
    const auto pixel = pixel_of(still, ptz, detected.ground.cast<double>(), size);
    const Vector<2> at = detected.pixel.cast<double>(), normal = detected.normal.cast<double>();
    off[0] = ((pixel.x() - T(at.x())) * T(normal.x()) + (pixel.y() - T(at.y())) * T(normal.y())) / T(detected.sigma);
    return true;
  }
};

struct StillPrior {
  TripodSolveOptions options;

  template <typename T>
  bool operator()(const T* still, T* off) const {
    off[0] = still[3] / T(options.lean_sigma);
    off[1] = still[4] / T(options.lean_sigma);
    off[2] = still[5] / T(options.roll_sigma);
    off[3] = (still[6] - T(options.ahead)) / T(options.ahead_sigma);
    off[4] = (still[7] - T(options.bend)) / T(options.bend_sigma);
    return true;
  }
};

struct LocationOff {
  LocationPrior near;

  template <typename T>
  bool operator()(const T* still, T* off) const {
    for (int i = 0; i < 3; ++i) off[i] = (still[i] - T(near.location(i))) / T(near.sigma(i));
    return true;
  }
};

std::vector<int> counts_by_line(std::span<const PaintSighting> paint) {
  std::vector<int> counts;
  for (const PaintSighting& one : paint) {
    if (one.line >= kFirstClick) continue;
    if (one.line >= static_cast<int>(counts.size())) counts.resize(static_cast<std::size_t>(one.line) + 1, 0);
    ++counts[static_cast<std::size_t>(one.line)];
  }
  return counts;
}

void add_frame(ceres::Problem& problem, const TripodFrameSight& frame, double* still, double* ptz, cv::Size size,
               const TripodSolveOptions& options) {
  const double sigma = options.click_px * size.width / 1280.0;
  for (const ClickedPosition& click : frame.clicks) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ClickOff, 2, kStill, 3>(new ClickOff{click, size, sigma}),
                             new ceres::CauchyLoss(3), still, ptz);
  }
  const std::vector<int> counts = counts_by_line(frame.paint);
  for (const PaintSighting& one : frame.paint) {
    if (one.line >= kFirstClick) continue;  // a frame's clicks are given as such
    const double weight = std::min(1.0, options.per_line / counts[static_cast<std::size_t>(one.line)]);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PaintOff, 1, kStill, 3>(new PaintOff{one, size}),
                             new ceres::ScaledLoss(new ceres::CauchyLoss(1.5), weight, ceres::TAKE_OWNERSHIP), still, ptz);
  }
}

/// The inverse of JᵀJ, the headings left free; `blocks` begins with the tripod's.
Matrix<kStill> covariance_of(ceres::Problem& problem, const std::vector<double*>& blocks) {
  ceres::Problem::EvaluateOptions how;
  how.parameter_blocks = blocks;
  ceres::CRSMatrix jacobian;
  problem.Evaluate(how, nullptr, nullptr, nullptr, &jacobian);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(jacobian.num_cols, jacobian.num_cols);
  for (int row = 0; row < jacobian.num_rows; ++row) {
    const auto begin = static_cast<std::size_t>(jacobian.rows[static_cast<std::size_t>(row)]),
               end = static_cast<std::size_t>(jacobian.rows[static_cast<std::size_t>(row) + 1]);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = begin; k < end; ++k)
        information(jacobian.cols[i], jacobian.cols[k]) += jacobian.values[i] * jacobian.values[k];
    }
  }
  const Eigen::Index free = information.cols() - kStill;
  const Eigen::MatrixXd across = information.topRightCorner(kStill, free);
  Eigen::MatrixXd own = information.bottomRightCorner(free, free);
  own.diagonal().array() += 1e-6;  // a heading that nothing determines
  Matrix<kStill> left = information.topLeftCorner(kStill, kStill);
  left -= across * own.ldlt().solve(across.transpose());
  left.diagonal().array() += 1e-9;
  return left.inverse();
}

std::vector<double> errors_of(const geometry::Tripod& tripod, const geometry::Heading& heading, const ClickedFrame& frame,
                              cv::Size size) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  std::vector<double> errors;
  for (const ClickedPosition& click : frame.locations)
    errors.push_back((pixel_of(numbers.data(), rotated.data(), click.ground, size) - click.pixel).norm());
  return errors;
}

std::vector<TripodFrameSight> sights_of(std::span<const ClickedFrame> frames, const TripodGuess& guess) {
  std::vector<TripodFrameSight> sights;
  for (std::size_t i = 0; i < frames.size(); ++i) sights.push_back({guess.headings[i], {}, frames[i].locations});
  return sights;
}

std::optional<TripodSolution> best_solution(std::span<const ClickedFrame> frames, cv::Size size, const geometry::PitchSize& pitch,
                                            const TripodSolveOptions& options) {
  std::optional<TripodSolution> best;
  for (const TripodGuess& guess : tripod_starts(frames, size, pitch, kStarts)) {
    TripodSolution found = solve_tripod(guess.tripod, sights_of(frames, guess), size, options);
    if (found.tripod.location.z() > kMinLevel && (!best || found.cost < best->cost)) best = std::move(found);
  }
  return best;
}

std::vector<ClickedFrame> reflected(std::vector<ClickedFrame> frames, const geometry::PitchSize& pitch) {
  for (ClickedFrame& frame : frames) {
    for (ClickedPosition& click : frame.locations) click.ground.y() = pitch.width - click.ground.y();
  }
  return frames;
}

void check_clicks(const std::vector<ClickedFrame>& frames) {
  std::size_t all = 0;
  for (const ClickedFrame& frame : frames) {
    if (frame.locations.size() < 2)
      throw Error("frame {}: {} place of the pitch is clicked; each frame needs 2 at least, better 4 to 8", frame.frame,
                  frame.locations.size());
    all += frame.locations.size();
  }
  if (frames.size() < 2 || all < 8)
    throw Error(
        "{} places in {} {} are clicked; at least 8 in 2 to 4 frames that look to different sides are needed to know where the "
        "tripod stands",
        all, frames.size(), frames.size() == 1 ? "frame" : "frames");
}

/// Whether one frame's clicks fit, with left and right exchanged or turned by half a turn, what the other frames show.
void check_halves(const std::vector<ClickedFrame>& frames, cv::Size size, const geometry::PitchSize& pitch,
                  const TripodSolveOptions& options, double cost) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const bool rotated : {false, true}) {
      std::vector<ClickedFrame> other = frames;
      for (ClickedPosition& click : other[i].locations) {
        click.ground.x() = pitch.length - click.ground.x();
        if (rotated) click.ground.y() = pitch.width - click.ground.y();
      }
      for (const auto& candidate : {other, reflected(other, pitch)}) {
        const auto found = best_solution(candidate, size, pitch, options);
        if (found && found->cost < kOtherHalf * cost)
          throw Error(
              "the clicks of frame {} contradict the others, and fit them on the other half of the pitch: there {} exchanged in "
              "frame {} or in all others?",
              frames[i].frame, rotated ? "both ends are" : "left and right are", frames[i].frame);
      }
    }
  }
}

}  // namespace

TripodSolution solve_tripod(const geometry::Tripod& start, std::span<const TripodFrameSight> frames, cv::Size size,
                            const TripodSolveOptions& options) {
  std::array<double, kStill> still = start.as_numbers();
  std::vector<Vector<3>> ptz;
  for (const TripodFrameSight& frame : frames) ptz.push_back(frame.heading.as_vector());
  ceres::Problem problem;
  for (std::size_t i = 0; i < frames.size(); ++i) add_frame(problem, frames[i], still.data(), ptz[i].data(), size, options);
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<StillPrior, 5, kStill>(new StillPrior{options}), nullptr, still.data());
  if (options.near)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LocationOff, 3, kStill>(new LocationOff{*options.near}), nullptr,
                             still.data());
  for (Vector<3>& heading : ptz) {  // a wrong start must not run away
    if (!problem.HasParameterBlock(heading.data())) continue;
    problem.SetParameterLowerBound(heading.data(), 2, -1);
    problem.SetParameterUpperBound(heading.data(), 2, 4);
  }
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_SCHUR;
  how.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (Vector<3>& heading : ptz) {
    if (problem.HasParameterBlock(heading.data())) how.linear_solver_ordering->AddElementToGroup(heading.data(), 0);
  }
  how.linear_solver_ordering->AddElementToGroup(still.data(), 1);
  how.max_num_iterations = 60;
  const auto summary = solve(how, problem);
  TripodSolution solution;
  solution.tripod = geometry::Tripod::of(still);
  for (const Vector<3>& heading : ptz) solution.headings.push_back(geometry::Heading::of(heading));
  solution.cost = summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
  std::vector<double*> blocks{still.data()};
  for (Vector<3>& heading : ptz) {
    if (problem.HasParameterBlock(heading.data())) blocks.push_back(heading.data());
  }
  solution.covariance = covariance_of(problem, blocks);
  return solution;
}

ClickedTripod tripod_from_clicks(const std::vector<ClickedFrame>& clicks, cv::Size size, const geometry::PitchSize& pitch,
                                 const TripodSolveOptions& options) {
  check_clicks(clicks);
  const std::vector<ClickedFrame> mirrored = reflected(clicks, pitch);
  const auto right = best_solution(clicks, size, pitch, options), left = best_solution(mirrored, size, pitch, options);
  if (!right && !left) throw Error("the clicks do not fit any camera on a tripod; is each with its place on the pitch?");
  ClickedTripod result;
  result.reflected = !right || (left && left->cost < kOtherHand * right->cost);
  result.either_hand = left && right && !result.reflected && left->cost * kOtherHand < right->cost;
  const TripodSolution& found = result.reflected ? *left : *right;
  const std::vector<ClickedFrame>& used = result.reflected ? mirrored : clicks;
  result.tripod = found.tripod;
  result.headings = found.headings;
  result.covariance = found.covariance;
  std::vector<double> all;
  double worst = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    result.error_px.push_back(errors_of(found.tripod, found.headings[i], used[i], size));
    all.insert(all.end(), result.error_px.back().begin(), result.error_px.back().end());
    worst = std::max(worst, geometry::median(std::vector(result.error_px.back())));
  }
  result.median_px = geometry::median(all);
  // Where most clicks lie on the halfway line, a frame on the wrong half contradicts a single click of the others.
  const bool one_far_off = *std::max_element(all.begin(), all.end()) > kWorstMedian * size.width;
  if (one_far_off || worst > 2 * options.click_px * size.width / 1280.0) check_halves(clicks, size, pitch, options, found.cost);
  if (worst > kWorstMedian * size.width)
    throw Error(
        "no camera on one tripod sees the clicked places within {:.0f} px of their clicks; clicks are on the wrong spot or have "
        "another place's name",
        worst);
  return result;
}

}  // namespace marey::calibrate::ptz
