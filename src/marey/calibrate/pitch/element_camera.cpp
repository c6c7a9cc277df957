#include "marey/calibrate/pitch/element_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/ceres.h>

#include "marey/calibrate/solve.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::pitch {
namespace {

constexpr std::size_t kMinElements = 2;
constexpr std::size_t kStarts = 4;
constexpr double kCoarse = 8;  // label sigmas: the scale of the loss before the wrong labels are known

struct LabelError {
  const geometry::PitchElement* model;
  Vector<2> point;
  double weight;

  template <typename T>
  bool operator()(const T* p, T* error) const {
    const ElementFrame<T> frame(p);
    const Eigen::Matrix<T, 2, 1> e = off(*model, frame, straightened(point, p[ElementView::bend]));
    error[0] = e.x() * weight;
    error[1] = e.y() * weight;
    return true;
  }
};

struct MainCameraPrior {
  std::array<double, ElementView::numbers> middle{}, weight{};

  template <typename T>
  bool operator()(const T* p, T* error) const {
    for (int i = 0; i < ElementView::numbers; ++i) error[i] = (p[i] - middle[i]) * weight[i];
    return true;
  }
};

MainCameraPrior prior_of(const ElementCameraOptions& options) {
  MainCameraPrior prior;
  const Vector<3> location = options.location + Vector<3>(options.pitch.length / 2, 0, 0);
  const auto set = [&](int number, double middle, double sigma) {
    prior.middle[number] = middle, prior.weight[number] = 1 / sigma;
  };
  set(ElementView::roll, 0, options.roll_sigma);
  set(ElementView::bend, options.bend, options.bend_sigma);
  set(ElementView::log_focal, std::log(options.focal), options.focal_sigma);
  for (int i = 0; i < 3; ++i) set(ElementView::x + i, location(i), options.position_sigma(i));
  return prior;
}

/// Least squares from `view`; returns the robust cost, or infinity.
double fit_view(ElementView& view, std::span<const ElementSight> sights, std::span<const char> used, double loss_sigmas,
                const ElementCameraOptions& options) {
  ceres::Problem problem;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!used[i]) continue;
    const double count = static_cast<double>(sights[i].points.size());
    const double weight = std::sqrt(std::min(1.0, options.points_of_element / count)) / options.label_sigma;
    for (const Vector<2>& point : sights[i].points) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LabelError, 2, ElementView::numbers>(new LabelError{&sights[i].model, point, weight}),
          new ceres::CauchyLoss(loss_sigmas), view.p.data());
    }
  }
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MainCameraPrior, ElementView::numbers, ElementView::numbers>(
                               new MainCameraPrior(prior_of(options))),
                           nullptr, view.p.data());
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  how.max_num_iterations = 60;
  how.function_tolerance = 1e-8;
  const ceres::Solver::Summary summary = calibrate::solve(how, problem);
  return summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
}

/// Where main cameras stand, for the starts: the prior's middle and a deviation to every side.
std::vector<Vector<3>> positions_of(const ElementCameraOptions& options) {
  const Vector<3> middle = options.location + Vector<3>(options.pitch.length / 2, 0, 0);
  std::vector<Vector<3>> locations;
  for (const double away : {0.0, 1.0, -1.0}) {
    for (const double up : {0.0, 1.0, -1.0}) {
      for (const double aside : {0.0, 1.0, -1.0})
        locations.emplace_back(middle + options.position_sigma.cwiseProduct(Vector<3>(aside, away, up)));
    }
  }
  return locations;
}

double median_error(const ElementView& view, const ElementSight& sight) {
  const ElementFrame<double> frame(view.p.data());
  std::vector<double> errors;
  for (const Vector<2>& point : sight.points)
    errors.push_back(off(sight.model, frame, straightened(point, view.p[ElementView::bend])).norm());
  return geometry::median(errors);
}

struct Fitted {
  ElementView view;
  double cost = std::numeric_limits<double>::infinity();
  std::vector<char> used;
  std::vector<double> errors;  // half image widths
  std::size_t fitting() const { return static_cast<std::size_t>(std::count(used.begin(), used.end(), 1)); }
  bool all_fit() const { return fitting() == used.size(); }
};

/// The best of several starts, with whole elements that do not fit omitted.
Fitted fit_elements(std::span<const ElementSight> sights, const ElementCameraOptions& options) {
  Fitted best;
  best.used.assign(sights.size(), 1);
  for (ElementView view : element_starts(sights, positions_of(options), kStarts)) {
    const double cost = fit_view(view, sights, best.used, kCoarse, options);
    if (cost < best.cost) best.cost = cost, best.view = view;
  }
  if (!std::isfinite(best.cost)) return best;
  for (int round = 0; round < 2; ++round) {
    best.errors.clear();
    for (std::size_t i = 0; i < sights.size(); ++i) {
      best.errors.push_back(median_error(best.view, sights[i]));
      best.used[i] = best.errors[i] < options.outlier ? 1 : 0;
    }
    if (round == 1 || best.fitting() < kMinElements) break;
    best.cost = fit_view(best.view, sights, best.used, 2, options);
  }
  return best;
}

/// How badly the labels are explained: each element's mean squared distance in label sigmas, none more than that of an outlier.
double unexplained(const Fitted& fitted, std::span<const ElementSight> sights, const ElementCameraOptions& options) {
  if (!std::isfinite(fitted.cost)) return std::numeric_limits<double>::infinity();
  return cut_off_cost(fitted.view, sights, options.outlier);
}

constexpr geometry::PitchMirror kAcross{.left_right = true}, kAlong{.near_far = true},
    kRotated{.left_right = true, .near_far = true};

/// Whether a mirrored pitch explains the labels clearly better than the one they name.
ElementVerdict evaluated(std::span<const geometry::LabelledElement> labels, cv::Size size, const Fitted& as_named, double cost,
                         const ElementCameraOptions& options) {
  ElementVerdict verdict = 2 * as_named.fitting() > as_named.used.size() ? ElementVerdict::found : ElementVerdict::no_camera;
  double minimum = options.mirror_margin * cost;
  for (const auto& [mirror, meaning] :
       {std::pair{kAcross, ElementVerdict::mirrored}, {kAlong, ElementVerdict::mirrored}, {kRotated, ElementVerdict::far_side}}) {
    std::vector<geometry::LabelledElement> renamed(labels.begin(), labels.end());
    for (geometry::LabelledElement& label : renamed) label.element = geometry::mirrored_element(label.element, mirror);
    const std::vector<ElementSight> sights = sights_of(renamed, options.pitch, size);
    const Fitted fitted = fit_elements(sights, options);
    const double other = unexplained(fitted, sights, options);
    if (other < minimum && fitted.fitting() > as_named.fitting()) minimum = other, verdict = meaning;
  }
  return verdict;
}

}  // namespace

geometry::Camera camera_of(const ElementView& view, cv::Size size) {
  const ElementFrame<double> frame(view.p.data());
  Rigid3 pose;
  pose.rotation << frame.right.transpose(), frame.down.transpose(), frame.ahead.transpose();
  pose.translation = -(pose.rotation * frame.centre);
  const double focal = frame.focal * size.width / 2;
  geometry::BrownLens lens{{focal, focal}, {(size.width - 1) / 2.0, (size.height - 1) / 2.0}, {}};
  lens.distortion[0] = view.p[ElementView::bend] * frame.focal * frame.focal;
  return {lens, pose, size};
}

std::string_view element_verdict_name(ElementVerdict verdict) {
  switch (verdict) {
    case ElementVerdict::found:
      return "found";
    case ElementVerdict::too_few:
      return "too few elements";
    case ElementVerdict::no_camera:
      return "no camera fits";
    case ElementVerdict::mirrored:
      return "left and right are exchanged";
    case ElementVerdict::far_side:
      return "the camera would stand on the far side";
  }
  return "";
}

ElementCamera camera_from_elements(std::span<const geometry::LabelledElement> labels, cv::Size size,
                                   const ElementCameraOptions& options) {
  ElementCamera result;
  const std::vector<ElementSight> sights = sights_of(labels, options.pitch, size);
  if (sights.size() < kMinElements || sights.size() != labels.size()) return result;
  const Fitted fitted = fit_elements(sights, options);
  const double cost = unexplained(fitted, sights, options);
  result.verdict = fitted.all_fit() && std::isfinite(cost) ? ElementVerdict::found : evaluated(labels, size, fitted, cost, options);
  if (result.verdict == ElementVerdict::found && fitted.view.p[ElementView::y] > options.pitch.width / 2)
    result.verdict = ElementVerdict::far_side;
  if (result.verdict != ElementVerdict::found) return result;
  result.view = fitted.view;
  result.used = fitted.used;
  for (const double error : fitted.errors) result.error_px.push_back(error * size.width / 2);
  result.camera = camera_of(fitted.view, size);
  return result;
}

}  // namespace marey::calibrate::pitch
