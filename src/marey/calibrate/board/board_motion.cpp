// Minimises the squared distances, px, between corners seen and predicted over the cameras' poses, offsets and shutters, as much
// of their lenses as is asked for, and the control poses of the board's path. A corner is predicted at the moment its row was
// exposed: the board is placed at the exposures of the top and of the bottom row, and a corner lies between the two places in
// proportion to its row. Second differences of neighbouring control poses are held to what a hand can do, so that the path stays
// defined where few corners are seen. Each image may have been taken a little before or after its time, as by webcams whose
// frames are grabbed when a program gets to it: how much so is evaluated by the scatter found, and ends at nothing if clocks are
// even. Derivatives are automatic. Cost: linear in views, a few thousand operations a corner and iteration.
#include "marey/calibrate/board/board_motion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <Eigen/Geometry>
#include <ceres/ceres.h>

#include "marey/calibrate/board/board_motion_errors.h"
#include "marey/calibrate/bundle/bundle_deviations.h"
#include "marey/calibrate/bundle/bundle_residual.h"
#include "marey/calibrate/solve.h"
#include "marey/calibrate/wand/rough_path.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::board {
namespace {

using Control = std::array<double, 7>;

constexpr int kRejectionRounds = 6;  // of judging outliers and clocks

struct View {
  std::size_t camera = 0;
  double time_s = 0;  // by the camera's clock
  std::vector<ObservedCorner> corners;
  double jitter_s = 0;  // its clock's own error
};

std::vector<View> views_of(const Board& board, std::span<const BoardRigCamera> cameras) {
  std::vector<View> views;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (const TimedView& detected : cameras[c].views) {
      View view{c, detected.time_s, {}};
      for (const BoardCorner& corner : detected.view.corners) {
        const double row = (corner.pixel.y() + 0.5) / cameras[c].size.height - 0.5;
        view.corners.push_back({corner.id, board.corner(corner.id), corner.pixel, row, true});
      }
      views.push_back(std::move(view));
    }
  }
  return views;
}

class Motion {
 public:
  Motion(const Board& board, std::span<const BoardRigCamera> cameras, const std::vector<std::vector<PosedView>>& poses,
         const std::vector<BoardRigPose>& start, const BoardMotionOptions& options)
      : inputs_(cameras), options_(options), views_(views_of(board, cameras)) {
    for (const BoardRigPose& camera : start) {
      lens_models_.push_back(camera.lens);
      poses_.push_back(bundle::numbers_of(camera.camera_from_world));
      lenses_.push_back(bundle::numbers_of(camera.lens));
      timings_.push_back({camera.offset_s, camera.readout_s});
    }
    const wand::RoughPath path(poses, start);
    begin_ = path.begin() - 2 * options.knot_s;
    for (const View& view : views_) {
      const int first = segment_of(view) - 2;  // with room for an offset that moves
      for (int k = first; k < first + 8; ++k) {
        if (controls_.contains(k)) continue;
        const Rigid3 pose = path.at(begin_ + (k - 1) * options.knot_s);
        const Eigen::Quaterniond q(pose.rotation);
        controls_[k] = {q.w(), q.x(), q.y(), q.z(), pose.translation.x(), pose.translation.y(), pose.translation.z()};
      }
    }
  }

  void solve(double loss_px) {
    build(loss_px);
    ceres::Solver::Options how;
    how.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    how.max_num_iterations = 30;
    how.function_tolerance = 1e-9;
    calibrate::solve(how, *problem_);
  }

  /// Evaluates every corner again by the noise of the others, and how even the cameras' clocks are.
  void assess() {
    std::vector<double> distances;
    for (const View& view : views_) {
      for (const auto& error : errors_of(view)) {
        if (error) distances.push_back(error->norm());
      }
    }
    if (distances.empty()) return;
    noise_px_ = std::max(kMinNoise, geometry::median(distances) / 1.1774);  // the median of a Rayleigh distribution
    const double limit = std::max(kAlwaysGood, kOutlierSigmas * noise_px_);
    double square = 0;
    for (const View& view : views_) square += view.jitter_s * view.jitter_s;
    if (jitter_s_ > 0) jitter_s_ = std::min(kUneven * options_.knot_s, std::sqrt(square / static_cast<double>(views_.size())));
    if (jitter_s_ < kEven * options_.knot_s) jitter_s_ = 0;
    for (View& view : views_) {
      const auto errors = errors_of(view);
      for (std::size_t i = 0; i < errors.size(); ++i) view.corners[i].inlier = errors[i] && errors[i]->norm() <= limit;
    }
  }

  /// From now on images may be taken a little before or after their time.
  void expect_jitter() { jitter_s_ = kUneven * options_.knot_s; }

  BoardRig report(bool deviations);

 private:
  static constexpr double kAlwaysGood = 0.5;  // px
  static constexpr double kOutlierSigmas = 6;
  static constexpr double kMinNoise = 0.02;  // px
  static constexpr double kEven = 0.003;     // of a frame: a clock's error that does not count
  static constexpr double kUneven = 0.03;    // of a frame: what is thought possible

  int segment_of(const View& view) const {
    return static_cast<int>(std::floor((view.time_s + timings_[view.camera][0] - begin_) / options_.knot_s));
  }
  bool controlled(int segment) const;
  std::vector<std::optional<Vector<2>>> errors_of(const View& view) const;
  ceres::CostFunction* error_of(const View& view, int segment, bool inliers_only) const;
  void build(double loss_px);
  void hold(std::size_t camera);
  void even_out(View& view);
  void smooth();
  void deviate(BoardRig& rig);

  std::span<const BoardRigCamera> inputs_;
  BoardMotionOptions options_;
  std::vector<View> views_;
  std::vector<geometry::Lens> lens_models_;
  std::vector<std::vector<double>> poses_, lenses_;
  std::vector<std::array<double, 2>> timings_;
  std::map<int, Control> controls_;
  double begin_ = 0;
  double noise_px_ = 1;  // each axis, as evaluated last
  double jitter_s_ = 0;  // standard deviation, as evaluated last
  std::unique_ptr<ceres::Problem> problem_;
  int equations_ = 0, unknowns_ = 0;
};

/// Whether all four control poses of a segment are there: an offset may have moved a view beyond them.
bool Motion::controlled(int segment) const {
  for (int k = segment; k < segment + 4; ++k) {
    if (!controls_.contains(k)) return false;
  }
  return true;
}

ceres::CostFunction* Motion::error_of(const View& view, int segment, bool inliers_only) const {
  std::vector<ObservedCorner> corners;
  std::ranges::copy_if(view.corners, std::back_inserter(corners),
                       [&](const ObservedCorner& c) { return c.inlier || !inliers_only; });
  if (corners.empty()) return nullptr;
  const double from_begin = view.time_s - (begin_ + segment * options_.knot_s);
  return std::visit(
      [&](const auto& model) -> ceres::CostFunction* {
        using Model = std::decay_t<decltype(model)>;
        constexpr int lens = bundle::kLensBase + Model::coefficients;
        const int count = 2 * static_cast<int>(corners.size());
        return new ceres::AutoDiffCostFunction<ViewError<Model>, ceres::DYNAMIC, 7, 7, 7, 7, bundle::kPose, lens, 2, 1>(
            new ViewError<Model>{std::move(corners), from_begin, options_.knot_s}, count);
      },
      lens_models_[view.camera]);
}

std::vector<std::optional<Vector<2>>> Motion::errors_of(const View& view) const {
  const int segment = segment_of(view);
  std::vector<std::optional<Vector<2>>> errors(view.corners.size());
  if (!controlled(segment)) return errors;
  const std::unique_ptr<ceres::CostFunction> cost(error_of(view, segment, false));
  std::array<const double*, 8> blocks{};
  for (std::size_t i = 0; i < 4; ++i) blocks[i] = controls_.at(segment + static_cast<int>(i)).data();
  blocks[4] = poses_[view.camera].data();
  blocks[5] = lenses_[view.camera].data();
  blocks[6] = timings_[view.camera].data();
  blocks[7] = &view.jitter_s;
  std::vector<double> numbers(2 * view.corners.size());
  if (!cost->Evaluate(blocks.data(), numbers.data(), nullptr)) return errors;
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = -Vector<2>(numbers[2 * i], numbers[2 * i + 1]);
  return errors;
}

void Motion::build(double loss_px) {
  problem_ = std::make_unique<ceres::Problem>();
  equations_ = 0;
  for (View& view : views_) {
    const int segment = segment_of(view);
    ceres::CostFunction* cost = controlled(segment) ? error_of(view, segment, true) : nullptr;
    if (!cost) continue;
    equations_ += cost->num_residuals();
    ceres::LossFunction* loss = loss_px > 0 ? new ceres::HuberLoss(loss_px * std::sqrt(cost->num_residuals())) : nullptr;
    problem_->AddResidualBlock(cost, loss, controls_[segment].data(), controls_[segment + 1].data(), controls_[segment + 2].data(),
                               controls_[segment + 3].data(), poses_[view.camera].data(), lenses_[view.camera].data(),
                               timings_[view.camera].data(), &view.jitter_s);
    even_out(view);
  }
  smooth();
  for (std::size_t c = 0; c < inputs_.size(); ++c) hold(c);
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  unknowns_ = 0;
  for (const double* block : blocks)
    unknowns_ += problem_->IsParameterBlockConstant(block) ? 0 : problem_->ParameterBlockTangentSize(block);
}

void Motion::smooth() {
  const double square = options_.knot_s * options_.knot_s;
  for (auto& [k, control] : controls_) {
    if (!problem_->HasParameterBlock(control.data())) continue;
    problem_->SetManifold(control.data(), new ceres::ProductManifold<ceres::QuaternionManifold, ceres::EuclideanManifold<3>>());
    const auto next = controls_.find(k + 1), after = controls_.find(k + 2);
    if (next == controls_.end() || after == controls_.end()) continue;
    if (!problem_->HasParameterBlock(next->second.data()) || !problem_->HasParameterBlock(after->second.data())) continue;
    problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<Smoothness, 6, 7, 7, 7>(
                                   new Smoothness{options_.acceleration * square / noise_px_, options_.ptz * square / noise_px_}),
                               nullptr, control.data(), next->second.data(), after->second.data());
    equations_ += 6;
  }
}

void Motion::even_out(View& view) {
  if (jitter_s_ > 0) {
    problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<Jitter, 1, 1>(new Jitter{noise_px_ / jitter_s_}), nullptr,
                               &view.jitter_s);
    ++equations_;
    return;
  }
  view.jitter_s = 0;
  problem_->SetParameterBlockConstant(&view.jitter_s);
}

void Motion::hold(std::size_t camera) {
  double* pose = poses_[camera].data();
  double* lens = lenses_[camera].data();
  double* timing = timings_[camera].data();
  if (!problem_->HasParameterBlock(pose)) return;
  if (camera == 0) problem_->SetParameterBlockConstant(pose);
  std::vector<int> held;
  if (camera == 0 || !options_.refine_offsets) held.push_back(0);
  if (!options_.refine_readout) held.push_back(1);
  if (held.size() == 2) problem_->SetParameterBlockConstant(timing);
  if (held.size() == 1) problem_->SetManifold(timing, new ceres::SubsetManifold(2, held));
  held.clear();
  const auto count = static_cast<int>(lenses_[camera].size());
  for (int i = bundle::kLensBase; i < count; ++i) {
    if (lens[i] == 0) held.push_back(i);  // what the calibration of the lens omitted
  }
  if (!options_.refine_lenses) {
    problem_->SetParameterBlockConstant(lens);
  } else if (!held.empty()) {
    problem_->SetManifold(lens, new ceres::SubsetManifold(count, held));
  }
}

BoardRig Motion::report(bool deviations) {
  BoardRig rig;
  double square = 0, sum = 0;
  for (std::size_t c = 0; c < inputs_.size(); ++c) {
    BoardRigPose camera;
    camera.lens = lens_models_[c];
    bundle::set_numbers(camera.lens, lenses_[c].data());
    camera.camera_from_world = bundle::pose_from(poses_[c].data());
    camera.offset_s = timings_[c][0];
    camera.readout_s = timings_[c][1];
    double own_square = 0, own_sum = 0;
    for (const View& view : views_) {
      if (view.camera != c) continue;
      const auto errors = errors_of(view);
      camera.observations += static_cast<int>(errors.size());
      for (std::size_t i = 0; i < errors.size(); ++i) {
        if (!view.corners[i].inlier || !errors[i]) continue;
        ++camera.inliers;
        own_square += errors[i]->squaredNorm();
        own_sum += errors[i]->norm();
      }
    }
    camera.rms_px = std::sqrt(own_square / std::max(1, camera.inliers));
    camera.mean_px = own_sum / std::max(1, camera.inliers);
    rig.inliers += camera.inliers;
    rig.observations += camera.observations;
    square += own_square;
    sum += own_sum;
    rig.cameras.push_back(std::move(camera));
  }
  rig.rms_px = std::sqrt(square / std::max(1, rig.inliers));
  rig.mean_px = sum / std::max(1, rig.inliers);
  rig.jitter_s = jitter_s_;
  rig.noise_px = std::sqrt(square / std::max(1, equations_ - unknowns_));
  if (deviations) deviate(rig);
  return rig;
}

void Motion::deviate(BoardRig& rig) {
  std::vector<std::pair<const double*, const double*>> required;
  for (std::size_t c = 1; c < inputs_.size(); ++c) {
    if (!problem_->HasParameterBlock(poses_[c].data())) continue;
    required.emplace_back(poses_[c].data(), poses_[c].data());
    required.emplace_back(timings_[c].data(), timings_[c].data());
  }
  ceres::Covariance::Options how;
  how.algorithm_type = ceres::SPARSE_QR;
  how.num_threads = 1;
  ceres::Covariance covariance(how);
  if (required.empty() || !covariance.Compute(required, problem_.get())) return;
  for (std::size_t c = 1; c < inputs_.size(); ++c) {
    if (!problem_->HasParameterBlock(poses_[c].data())) continue;
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> pose;
    Eigen::Matrix<double, 2, 2, Eigen::RowMajor> timing;
    covariance.GetCovarianceBlock(poses_[c].data(), poses_[c].data(), pose.data());
    covariance.GetCovarianceBlock(timings_[c].data(), timings_[c].data(), timing.data());
    rig.cameras[c].offset_deviation_s = rig.noise_px * std::sqrt(std::max(0.0, timing(0, 0)));
    const Eigen::Matrix<double, 3, 6> centre = bundle::centre_by_pose(rig.cameras[c].camera_from_world);
    rig.cameras[c].centre_deviation = rig.noise_px * (centre * pose * centre.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  }
}

}  // namespace

BoardRig fit_board_motion(const Board& board, std::span<const BoardRigCamera> cameras,
                          const std::vector<std::vector<PosedView>>& poses, const std::vector<BoardRigPose>& start,
                          const BoardMotionOptions& options, bool deviations) {
  Motion motion(board, cameras, poses, start, options);
  motion.solve(2);
  motion.expect_jitter();
  for (int round = 0; round < kRejectionRounds; ++round) {
    motion.solve(round == 0 ? 2 : 0);
    motion.assess();
  }
  motion.solve(0);
  return motion.report(deviations);
}

}  // namespace marey::calibrate::board
