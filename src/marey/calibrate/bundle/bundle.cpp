#include "marey/calibrate/bundle/bundle.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <glog/logging.h>

#include "marey/calibrate/bundle/bundle_deviations.h"
#include "marey/calibrate/bundle/bundle_residual.h"
#include "marey/calibrate/solve.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::bundle {
namespace {

using bundle::kLensBase;

Vector<3> site_of(const Bundle& bundle, const BundleObservation& detected) {
  const Body& body = bundle.bodies[static_cast<std::size_t>(detected.body)];
  const auto marker = static_cast<std::size_t>(detected.marker);
  if (std::holds_alternative<WandPose>(body)) return {bundle.wand[marker], 0, 0};
  if (std::holds_alternative<Rigid3>(body)) return bundle.board[marker];
  return Vector<3>::Zero();
}

/// The numbers that Ceres moves, and the path back into the bundle. All lie in one piece of memory: Ceres orders by address, and
/// so results are the same from run to run.
class Numbers {
 public:
  explicit Numbers(const Bundle& bundle) {
    std::vector<std::size_t> begins;
    const auto add = [&](const std::vector<double>& some) {
      begins.push_back(memory_.size());
      memory_.insert(memory_.end(), some.begin(), some.end());
    };
    for (const Body& body : bundle.bodies) add(bundle::numbers_of(body));
    for (const BundleCamera& camera : bundle.cameras) {
      add(bundle::numbers_of(camera.camera_from_world));
      add(bundle::numbers_of(camera.lens));
      add({camera.offset_s});
    }
    for (std::size_t i = 0; i < begins.size(); ++i) {
      double* at = memory_.data() + begins[i];
      if (i < bundle.bodies.size()) {
        bodies.push_back(at);
      } else {
        std::array{&poses, &lenses, &offsets}[(i - bundle.bodies.size()) % 3]->push_back(at);
      }
    }
  }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  void store(Bundle& bundle) const {
    for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
      BundleCamera& camera = bundle.cameras[c];
      if (camera.refine_pose) camera.camera_from_world = bundle::pose_from(poses[c]);
      bundle::set_numbers(camera.lens, lenses[c]);
      camera.offset_s = *offsets[c];
    }
    for (std::size_t b = 0; b < bundle.bodies.size(); ++b) bundle::set_numbers(bundle.bodies[b], bodies[b]);
  }

  std::vector<double*> poses, lenses, offsets, bodies;

 private:
  std::vector<double> memory_;
};

/// Ceres's problem over the inliers. The order of elimination, bodies first, is the ordering's.
class Problem {
 public:
  Problem(const Bundle& bundle, const std::vector<BundleCamera>& start, const std::vector<char>& inlier,
          const BundleOptions& options)
      : bundle_(bundle), numbers_(bundle), loss_(options.loss_sigmas * options.noise_px), problem_(keep_parts()) {
    for (std::size_t i = 0; i < bundle.observations.size(); ++i) {
      if (inlier[i]) add(bundle.observations[i]);
    }
    for (std::size_t c = 0; c < bundle.cameras.size(); ++c) hold_and_weigh(c, start[c].lens, options.noise_px);
  }

  bool solve(Bundle& bundle, const BundleOptions& options) {
    ceres::Solver::Options how;
    how.linear_solver_type = ceres::DENSE_SCHUR;
    how.linear_solver_ordering = ordering();
    how.max_num_iterations = options.iterations;
    how.function_tolerance = options.tolerance;
    how.parameter_tolerance = 1e-12;
    how.gradient_tolerance = 1e-12;
    how.max_trust_region_radius = 1e8;  // damped a little always: a single light's scale is free
    const ceres::Solver::Summary summary = calibrate::solve(how, problem_);
    if (summary.IsSolutionUsable()) numbers_.store(bundle);
    return summary.termination_type == ceres::CONVERGENCE;
  }

 private:
  static ceres::Problem::Options keep_parts() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void add(const BundleObservation& detected) {
    const auto c = static_cast<std::size_t>(detected.camera), b = static_cast<std::size_t>(detected.body);
    const BundleCamera& camera = bundle_.cameras[c];
    const Body& body = bundle_.bodies[b];
    ceres::CostFunction* cost =
        bundle::make_reprojection(camera.lens, body, site_of(bundle_, detected), detected, camera.refine_offset);
    std::vector<double*> blocks = {numbers_.poses[c], numbers_.lenses[c], numbers_.bodies[b]};
    if (camera.refine_offset) blocks.push_back(numbers_.offsets[c]);
    problem_.AddResidualBlock(cost, &loss_, blocks);
    if (std::holds_alternative<WandPose>(body)) problem_.SetManifold(blocks[2], &wand_manifold_);
  }

  void hold_and_weigh(std::size_t c, const geometry::Lens& start, double noise_px) {
    double* pose = numbers_.poses[c];
    double* lens = numbers_.lenses[c];
    if (!problem_.HasParameterBlock(pose)) return;
    if (!bundle_.cameras[c].refine_pose) problem_.SetParameterBlockConstant(pose);
    const std::vector<double> sigma = bundle::lens_sigmas(start, bundle_.cameras[c].freedom);
    const auto count = static_cast<int>(sigma.size());
    std::vector<int> held;
    for (int i = 0; i < count; ++i) {
      if (sigma[static_cast<std::size_t>(i)] == 0) held.push_back(i);
    }
    if (static_cast<int>(held.size()) == count) {
      problem_.SetParameterBlockConstant(lens);
      return;
    }
    if (!held.empty()) {
      manifolds_.push_back(std::make_unique<ceres::SubsetManifold>(count, held));
      problem_.SetManifold(lens, manifolds_.back().get());
    }
    const std::vector<double> at = bundle::numbers_of(start);
    ceres::Matrix A = ceres::Matrix::Zero(count, count);
    for (int i = 0; i < count; ++i) {
      const double s = sigma[static_cast<std::size_t>(i)];
      if (s > 0 && std::isfinite(s)) A(i, i) = noise_px / s;
    }
    if (A.isZero(0)) return;
    problem_.AddResidualBlock(new ceres::NormalPrior(A, Eigen::Map<const Eigen::VectorXd>(at.data(), count)), nullptr, lens);
  }

  std::shared_ptr<ceres::ParameterBlockOrdering> ordering() {
    auto order = std::make_shared<ceres::ParameterBlockOrdering>();
    for (double* body : numbers_.bodies) {
      if (problem_.HasParameterBlock(body)) order->AddElementToGroup(body, 0);
    }
    for (std::size_t c = 0; c < numbers_.poses.size(); ++c) {
      for (double* block : {numbers_.poses[c], numbers_.lenses[c], numbers_.offsets[c]}) {
        if (problem_.HasParameterBlock(block)) order->AddElementToGroup(block, 1);
      }
    }
    return order;
  }

  const Bundle& bundle_;
  Numbers numbers_;
  ceres::HuberLoss loss_;
  ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::SphereManifold<3>> wand_manifold_;
  std::vector<std::unique_ptr<ceres::Manifold>> manifolds_;
  ceres::Problem problem_;
};

/// Puts out the observations of bodies that too few hold: two cameras at least (a board: one), and more numbers seen than sought.
void drop_loose_bodies(const Bundle& bundle, std::vector<char>& inlier) {
  struct Hold {
    int first_camera = -1, equations = 0;
    bool several = false;
  };
  std::vector<Hold> holds(bundle.bodies.size());
  for (std::size_t i = 0; i < inlier.size(); ++i) {
    if (!inlier[i]) continue;
    Hold& hold = holds[static_cast<std::size_t>(bundle.observations[i].body)];
    if (hold.first_camera < 0) hold.first_camera = bundle.observations[i].camera;
    hold.several |= hold.first_camera != bundle.observations[i].camera;
    hold.equations += 2;
  }
  constexpr std::array unknowns = {3, 5, 6};
  for (std::size_t i = 0; i < inlier.size(); ++i) {
    const auto b = static_cast<std::size_t>(bundle.observations[i].body);
    const std::size_t kind = bundle.bodies[b].index();
    if (holds[b].equations <= unknowns[kind] || (kind != 2 && !holds[b].several)) inlier[i] = 0;
  }
}

/// Noise of one axis by the median of the inliers' distances (of a Rayleigh distribution: 1.1774 σ).
double median_noise(const std::vector<std::optional<Vector<2>>>& errors, const std::vector<char>& inlier) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (inlier[i] && errors[i]) distances.push_back(errors[i]->norm());
  }
  if (distances.empty()) return 0;
  return geometry::median(distances) / 1.1774;
}

/// Evaluates every observation again; true where any verdict changed.
bool assess(const Bundle& bundle, const BundleOptions& options, std::vector<char>& inlier) {
  const auto errors = errors_of(bundle);
  const double limit = std::max(options.min_outlier_px, options.outlier_sigmas * median_noise(errors, inlier));
  std::vector<char> verdict(inlier.size());
  for (std::size_t i = 0; i < verdict.size(); ++i) verdict[i] = errors[i] && errors[i]->norm() <= limit;
  drop_loose_bodies(bundle, verdict);
  const bool changed = verdict != inlier;
  inlier = std::move(verdict);
  return changed;
}

void sum_up(const Bundle& bundle, BundleResult& result) {
  const auto errors = errors_of(bundle);
  double distance = 0, square = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!result.inlier[i]) continue;
    if (!errors[i]) {
      result.inlier[i] = 0;
      continue;
    }
    ++result.inliers;
    distance += errors[i]->norm();
    square += errors[i]->squaredNorm();
  }
  if (result.inliers == 0) return;
  result.mean_px = distance / result.inliers;
  result.rms_px = std::sqrt(square / result.inliers);
  const int freedom = 2 * result.inliers - bundle::free_numbers(bundle, result.inlier);
  result.noise_px = std::sqrt(square / std::max(1, freedom));
}

}  // namespace

Vector<3> marker_position(const Bundle& bundle, const BundleObservation& detected) {
  const Body& body = bundle.bodies[static_cast<std::size_t>(detected.body)];
  const Vector<3> site = site_of(bundle, detected);
  if (const auto* point = std::get_if<Vector<3>>(&body)) return *point;
  if (const auto* board = std::get_if<Rigid3>(&body)) return *board * site;
  const auto& wand = std::get<WandPose>(body);
  return wand.origin + site.x() * wand.direction;
}

std::optional<Vector<2>> predicted_pixel(const Bundle& bundle, const BundleObservation& detected) {
  const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(detected.camera)];
  const Vector<3> in_camera = camera.camera_from_world * marker_position(bundle, detected);
  return std::visit(
      [&](const auto& model) -> std::optional<Vector<2>> {
        if (model.ahead_only && !(in_camera.z() > 1e-6)) return std::nullopt;
        const Vector<2> pixel = model.principal + model.focal.cwiseProduct(model.distort(in_camera, model.distortion.data()));
        if (!pixel.allFinite()) return std::nullopt;
        return pixel;
      },
      camera.lens);
}

std::vector<std::optional<Vector<2>>> errors_of(const Bundle& bundle) {
  std::vector<std::optional<Vector<2>>> errors;
  errors.reserve(bundle.observations.size());
  for (const BundleObservation& detected : bundle.observations) {
    const auto pixel = predicted_pixel(bundle, detected);
    if (!pixel) {
      errors.emplace_back();
      continue;
    }
    const double offset = bundle.cameras[static_cast<std::size_t>(detected.camera)].offset_s;
    errors.emplace_back(detected.pixel - detected.velocity * offset - *pixel);
  }
  return errors;
}

BundleResult adjust(Bundle& bundle, const BundleOptions& options) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports every step that it has to shorten; a library prints nothing
  BundleResult result;
  std::vector<BundleCamera> start = bundle.cameras;  // prior values stay as they were in every round
  for (BundleCamera& camera : start) camera.lens = camera.known.value_or(camera.lens);
  const auto errors = errors_of(bundle);
  for (const auto& error : errors) result.inlier.push_back(error.has_value());
  drop_loose_bodies(bundle, result.inlier);
  for (int round = 0; round <= options.rounds; ++round) {
    const bool any = std::count(result.inlier.begin(), result.inlier.end(), 1) > 0;
    if (any) result.converged = Problem(bundle, start, result.inlier, options).solve(bundle, options);
    if (!any || round == options.rounds || !assess(bundle, options, result.inlier)) break;
  }
  sum_up(bundle, result);
  if (options.deviations) result.deviations = bundle::deviations_of(bundle, start, result.inlier, result.noise_px);
  return result;
}

}  // namespace marey::calibrate::bundle
