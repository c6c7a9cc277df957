#include "marey/calibrate/lens_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/calibrate/board/board_pose.h"
#include "marey/calibrate/lens_start.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey::calibrate {
namespace {

constexpr int kMinViews = 3;
constexpr int kRounds = 6;
constexpr double kMinSpread = 5 * std::numbers::pi / 180;  // between the directions that boards face
constexpr double kWorseThanOthers = 4;                     // times the median error: then a view is put out whole
constexpr double kAlwaysGood = 0.5;                        // px: but never one as good as this

bundle::LensFreedom freedom_of(const LensOptions& options, int step) {
  bundle::LensFreedom freedom;
  freedom.focal = bundle::LensFreedom::free;
  if (step >= 1) freedom.distortion[0] = bundle::LensFreedom::free;
  if (step < 2) return freedom;
  freedom.principal = bundle::LensFreedom::free;
  freedom.aspect = options.square_pixels ? 0 : bundle::LensFreedom::free;
  const auto model = geometry::lens_named(options.model);
  const int count = model ? std::min(options.coefficients, geometry::coefficients_of(*model)) : options.coefficients;
  for (std::size_t i = 0; i < freedom.distortion.size(); ++i)
    freedom.distortion[i] = static_cast<int>(i) < count ? bundle::LensFreedom::free : 0;
  return freedom;
}

/// One static camera still, one board for each view.
class Solver {
 public:
  Solver(const board::Board& board, std::span<const LensView> views, const LensOptions& options, const geometry::Lens& start)
      : board_(board), views_(views), options_(options), used_(views.size(), true) {
    for (int id = 0; id < board.corner_count(); ++id) bundle_.board.push_back(board.corner(id));
    bundle_.cameras.push_back({start, {}, 0, {}, false, false});
    for (std::size_t i = 0; i < views.size(); ++i) {
      const auto pose = board::board_pose(board, views[i].board, start);
      used_[i] = pose.has_value();
      bundle_.bodies.emplace_back(pose.value_or(Rigid3{}));
    }
  }

  /// Step by step from the focal length to all numbers; no corner is excluded in between.
  void approach() {
    bundle::BundleOptions how;
    how.rounds = 0;
    how.deviations = false;
    how.tolerance = 1e-6;
    for (int step = 0; step < 3; ++step) {
      how.noise_px = step < 2 ? 3 : 1;
      solve(step, how);
    }
  }

  /// Puts out views that fit far worse than most, and takes back those that, by the lens without them, do not.
  void refuse_bad_views() {
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<double> misfit = view_misfit();
      std::vector<double> sorted = misfit;
      std::ranges::sort(sorted);
      const double limit = std::max(kAlwaysGood, kWorseThanOthers * sorted[(sorted.size() - 1) / 2]);
      std::vector<bool> verdict;
      for (const double here : misfit) verdict.push_back(here <= limit);
      if (verdict == used_ || std::ranges::count(verdict, true) < kMinViews) return;
      for (std::size_t i = 0; i < verdict.size(); ++i) {
        if (verdict[i] && !used_[i]) bundle_.bodies[i] = *board::board_pose(board_, views_[i].board, bundle_.cameras[0].lens);
      }
      used_ = verdict;
      bundle::BundleOptions how;
      how.rounds = 0;
      how.deviations = false;
      solve(2, how);
    }
  }

  bundle::BundleResult finish() {
    bundle::BundleOptions how;
    how.noise_px = std::max(0.02, last_.noise_px);
    how.min_outlier_px = 0.5;
    how.outlier_sigmas = 6;
    last_ = solve(2, how);
    return last_;
  }

  const bundle::Bundle& bundle() const { return bundle_; }
  bool used(std::size_t view) const { return used_[view]; }
  int used_views() const { return static_cast<int>(std::ranges::count(used_, true)); }

 private:
  bundle::BundleResult solve(int step, const bundle::BundleOptions& how) {
    bundle_.observations.clear();
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!used_[i]) continue;
      for (const board::BoardCorner& corner : views_[i].board.corners)
        bundle_.observations.push_back({0, static_cast<int>(i), corner.id, corner.pixel, Vector<2>::Zero()});
    }
    bundle_.cameras[0].freedom = freedom_of(options_, step);
    last_ = bundle::adjust(bundle_, how);
    return last_;
  }

  /// How far corners are off in every view, used or not: the median, px, which single wrong corners do not move. 1e6 where the
  /// lens as it is gives no pose.
  std::vector<double> view_misfit() const {
    const geometry::Lens& lens = bundle_.cameras[0].lens;
    std::vector<double> all;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const board::BoardView& view = views_[i].board;
      const auto pose = used_[i] ? std::optional(std::get<Rigid3>(bundle_.bodies[i])) : board::board_pose(board_, view, lens);
      std::vector<double> distances;
      for (const board::BoardCorner& corner : view.corners) {
        const auto pixel = pose ? board::pixel_of(lens, *pose * board_.corner(corner.id)) : std::nullopt;
        distances.push_back(pixel ? (*pixel - corner.pixel).norm() : 1e6);
      }
      all.push_back(geometry::median(distances));
    }
    return all;
  }

  const board::Board& board_;
  std::span<const LensView> views_;
  const LensOptions& options_;
  std::vector<bool> used_;
  bundle::Bundle bundle_;
  bundle::BundleResult last_;
};

/// The widest angle between the planes of two used boards, whichever side of them is seen, rad.
double spread_of(const Solver& solver) {
  std::vector<Vector<3>> normals;
  for (std::size_t i = 0; i < solver.bundle().bodies.size(); ++i) {
    if (!solver.used(i)) continue;
    const Vector<3> normal = std::get<Rigid3>(solver.bundle().bodies[i]).rotation.col(2);
    normals.push_back(normal.z() < 0 ? Vector<3>(-normal) : normal);
  }
  double widest = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) widest = std::max(widest, std::acos(std::clamp(normals[i].dot(normals[j]), -1.0, 1.0)));
  }
  return widest;
}

double covered_fraction(const std::vector<LensCalibration::View>& views, const cv::Size& size) {
  constexpr int columns = 10, rows = 8;
  std::set<std::pair<int, int>> fields;
  for (const LensCalibration::View& view : views) {
    if (!view.refused.empty()) continue;
    for (const Vector<2>& p : view.pixels) {
      fields.emplace(std::clamp(static_cast<int>((p.x() + 0.5) / size.width * columns), 0, columns - 1),
                     std::clamp(static_cast<int>((p.y() + 0.5) / size.height * rows), 0, rows - 1));
    }
  }
  return static_cast<double>(fields.size()) / (columns * rows);
}

std::vector<LensCalibration::View> describe(const board::Board& board, std::span<const LensView> views, const Solver& solver) {
  std::vector<LensCalibration::View> described;
  const geometry::Lens& lens = solver.bundle().cameras[0].lens;
  for (std::size_t i = 0; i < views.size(); ++i) {
    LensCalibration::View view;
    view.name = views[i].name;
    for (const board::BoardCorner& corner : views[i].board.corners) view.pixels.push_back(corner.pixel);
    const auto pose = solver.used(i) ? std::optional(std::get<Rigid3>(solver.bundle().bodies[i]))
                                     : board::board_pose(board, views[i].board, lens);
    const auto rms = pose ? board::board_rms(board, views[i].board, lens, *pose) : std::nullopt;
    if (rms) {
      view.camera_from_board = pose;
      view.rms_px = *rms;
      for (const board::BoardCorner& corner : views[i].board.corners)
        view.errors.push_back(corner.pixel - *board::pixel_of(lens, *pose * board.corner(corner.id)));
    }
    if (!solver.used(i)) {
      view.refused =
          rms ? fmt::format("its corners miss by {:.2f} px, far more than in the other images: blurred, or the board bent", *rms)
              : "its corners give no pose of the board";
    }
    described.push_back(std::move(view));
  }
  return described;
}

void warn(LensCalibration& result, double spread, int used) {
  if (used < 8) result.warnings.push_back(fmt::format("only {} images were usable; take 15 or more", used));
  if (result.covered < 0.5) {
    result.warnings.push_back(
        fmt::format("corners cover {:.0f} % of the image: towards its edges the distortion is a guess; bring the board there",
                    100 * result.covered));
  }
  if (spread < 0.35)
    result.warnings.push_back(
        fmt::format("the board was tilted by no more than {:.0f}°: tilt it by 30° and more, so that the focal length shows",
                    spread * 180 / std::numbers::pi));
  if (result.deviation.focal > 0.01)
    result.warnings.push_back(fmt::format("the focal length is known to no better than {:.1f} %", 100 * result.deviation.focal));
}

}  // namespace

std::vector<std::string> lens_models() {
  const auto names = geometry::lens_names();
  return {names.begin(), names.end()};
}

LensCalibration calibrate_lens(const board::Board& board, cv::Size size, std::span<const LensView> views,
                               const LensOptions& options) {
  if (static_cast<int>(views.size()) < kMinViews)
    throw Error(
        "the board was seen in {} images, and a lens needs {} at least; show it in 15 or more, near and far, tilted, and in "
        "every corner of the image",
        views.size(), kMinViews);
  const auto start = first_lens(board, size, views, options.model);
  if (!start)
    throw Error("no focal length explains what was seen of the board; is {} the board in the images?", board::to_string(board));
  Solver solver(board, views, options, *start);
  solver.approach();
  solver.refuse_bad_views();
  if (solver.used_views() < kMinViews)
    throw Error(
        "only {} images of the board agree with each other, and a lens needs {} at least; is {} the board in the images, flat "
        "and still?",
        solver.used_views(), kMinViews, board::to_string(board));
  const bundle::BundleResult found = solver.finish();
  const double spread = spread_of(solver);
  if (spread < kMinSpread)
    throw Error(
        "the board faces the camera at the same angle in all images (within {:.1f}°), so that its distance and the focal length "
        "cannot be distinguished; tilt it by 30° and more, "
        "to both sides and up and down",
        spread * 180 / std::numbers::pi);
  LensCalibration result;
  result.lens = solver.bundle().cameras[0].lens;
  result.size = size;
  result.deviation = found.deviations[0];
  result.rms_px = found.rms_px;
  result.mean_px = found.mean_px;
  result.noise_px = found.noise_px;
  result.inliers = found.inliers;
  for (const LensView& view : views) result.observations += static_cast<int>(view.board.corners.size());
  result.views = describe(board, views, solver);
  result.covered = covered_fraction(result.views, size);
  warn(result, spread, solver.used_views());
  return result;
}

}  // namespace marey::calibrate
