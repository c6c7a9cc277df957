#include "marey/solve/skeleton/calibrate.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kTightM = 0.005;          // by definition: a marker that sits so tightly counts 1 while the person's size is found
constexpr double kContradictedSigmas = 3;  // numerical: beyond, a posture is not the one that was assumed

/// "femur_r" and "femur_l", "right_thigh" and "left_thigh", "RightLeg" and "LeftLeg" are one.
std::string without_side(std::string name) {
  for (const auto& [right, left] : {std::pair<std::string, std::string>{"right", "left"}, {"Right", "Left"}}) {
    for (const std::string& word : {right, left}) {
      if (const auto at = name.find(word); at != std::string::npos) return name.erase(at, word.size());
    }
  }
  if (name.size() > 2 && (name.ends_with("_r") || name.ends_with("_l"))) name.resize(name.size() - 2);
  return name;
}

class Calibrator {
 public:
  Calibrator(const Skeleton& skeleton, std::span<const ObservedMarkers> frames, const CalibrateOptions& options)
      : base_(skeleton), options_(options) {
    const std::size_t step = std::max<std::size_t>(1, frames.size() / static_cast<std::size_t>(std::max(1, options.frames)));
    for (std::size_t f = 0; f < frames.size(); f += step) frames_.push_back(&frames[f]);
    if (options_.standing) frames_.push_back(&*options_.standing);
    std::map<std::string, int> groups;
    for (const Segment& segment : skeleton.segments)
      group_of_.push_back(groups.try_emplace(without_side(segment.name), static_cast<int>(groups.size())).first->second);
    group_scale_.assign(groups.size(), Vector<3>::Ones());
    offsets_.assign(skeleton.markers.size(), Vector<3>::Zero());
    centre_.setOnes(3 * std::ssize(group_scale_));
    find_twins();
    if (!options_.offset_sigmas_m.empty()) weigh_markers();
  }

  Calibration run() {
    if (frames_.empty()) throw Error("{}: there are no frames to fit the skeleton to", base_.name);
    Calibration result;
    solve_poses();
    result.rms_before_m = rms_;
    if (options_.overall) result.overall_scale = find_overall();
    weigh_alike();
    for (int round = 0; round < options_.rounds; ++round) {
      solve_poses();
      if (!improve()) break;
    }
    solve_poses();
    result.rms_after_m = rms_;
    if (options_.scale_sigma > 0) result.undetermined = undetermined(result.undetermined_markers);
    if (options_.standing) result.standing = poses_.back();
    result.skeleton = now_;
    for (std::size_t j = 0; j < offsets_.size(); ++j)
      result.skeleton.markers[j].weight = given_weights_.empty() ? base_.markers[j].weight : given_weights_[j];
    for (std::size_t s = 0; s < base_.segments.size(); ++s) result.scales.push_back(scale_of(s));
    for (std::size_t j = 0; j < offsets_.size(); ++j) result.marker_moved_m.push_back(offsets_[j].norm());
    return result;
  }

 private:
  /// Markers of the other side on the same bones: "L.Knee.Lat" of "R.Knee.Lat".
  void find_twins() {
    std::map<std::string, std::size_t> by_name;
    for (std::size_t j = 0; j < base_.markers.size(); ++j) by_name[base_.markers[j].label] = j;
    for (std::size_t j = 0; j < base_.markers.size(); ++j) {
      std::string label = base_.markers[j].label;
      if (label.size() < 2 || label[0] != 'L') continue;
      label[0] = 'R';
      const auto other = by_name.find(label);
      if (other == by_name.end()) continue;
      const auto a = static_cast<std::size_t>(base_.markers[j].segment),
                 b = static_cast<std::size_t>(base_.markers[other->second].segment);
      if (group_of_[a] == group_of_[b]) twins_.emplace_back(j, other->second);
    }
    // The axis across: along which twins lie on either side.
    Vector<3> opposite = Vector<3>::Zero();
    for (const auto& [left, right] : twins_) opposite += base_.markers[left].position.cwiseProduct(base_.markers[right].position);
    opposite.minCoeff(&across_);
  }

  /// While the size is found, what sits loosely counts little.
  void weigh_markers() {
    for (std::size_t j = 0; j < base_.markers.size(); ++j) {
      given_weights_.push_back(base_.markers[j].weight);
      const double sigma = std::hypot(options_.offset_sigmas_m[j], options_.marker_sigma_m);
      base_.markers[j].weight *= kTightM * kTightM / (sigma * sigma);
    }
  }
  void weigh_alike() {
    for (std::size_t j = 0; j < given_weights_.size(); ++j) base_.markers[j].weight = given_weights_[j];
  }

  double offset_sigma(std::size_t marker) const {
    return options_.offset_sigmas_m.empty() ? options_.offset_sigma_m : options_.offset_sigmas_m[marker];
  }

  const Vector<3>& scale_of(std::size_t segment) const { return group_scale_[static_cast<std::size_t>(group_of_[segment])]; }

  void apply() {
    std::vector<Vector<3>> scales;
    for (std::size_t s = 0; s < base_.segments.size(); ++s) scales.push_back(scale_of(s));
    now_ = scaled(base_, scales);
    for (std::size_t j = 0; j < offsets_.size(); ++j) now_.markers[j].position += offsets_[j];
  }

  void solve_poses() {
    apply();
    PoseSolver solver(now_, {.marker_sigma_m = options_.marker_sigma_m, .robust_m = 0.2, .shift_s = 0});
    poses_.clear();
    double sum = 0;
    int count = 0;
    for (const ObservedMarkers* frame : frames_) {
      if (stands(*frame)) solver.forget();  // it is of another take
      const SolvedPose& pose = solver.step(0.1, *frame);
      poses_.push_back(pose.coordinates);
      sum += pose.rms_m * pose.rms_m * pose.detected;
      count += pose.detected;
    }
    if (count == 0) throw Error("{}: none of the frames shows one of the skeleton's markers", base_.name);
    rms_ = std::sqrt(sum / count);
  }

  /// The one scale of the whole person, by golden section: poses are solved again for each.
  double find_overall() {
    const auto rms_at = [&](double scale) {
      std::fill(group_scale_.begin(), group_scale_.end(), Vector<3>::Constant(scale));
      solve_poses();
      return rms_;
    };
    constexpr double kGolden = 0.6180339887498949;
    double low = 0.6, high = 1.4;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low), at_a = rms_at(a), at_b = rms_at(b);
    while (high - low > 0.005) {
      if (at_a < at_b) {
        high = std::exchange(b, a);
        at_b = std::exchange(at_a, rms_at(a = high - kGolden * (high - low)));
        at_a = rms_;
      } else {
        low = std::exchange(a, b);
        at_a = std::exchange(at_b, rms_at(b = low + kGolden * (high - low)));
        at_b = rms_;
      }
    }
    const double best = 0.5 * (low + high);
    centre_.setConstant(best);
    rms_at(best);
    return best;
  }

  /// How marker `j` moves with the scales of the segments between it and the root, and with its own offset.
  void add_derivatives(std::size_t j, const std::vector<Rigid3>& pose, Eigen::MatrixXd& by) const {
    const auto own = static_cast<std::size_t>(now_.markers[j].segment);
    const auto columns = [&](std::size_t s) { return by.middleCols(3 * group_of_[s], 3); };
    columns(own) += pose[own].rotation * base_.markers[j].position.asDiagonal();
    for (std::size_t s = own; base_.segments[s].parent; s = static_cast<std::size_t>(*base_.segments[s].parent)) {
      const auto parent = static_cast<std::size_t>(*base_.segments[s].parent);
      columns(parent) += pose[parent].rotation * base_.segments[s].joint.parent_from_joint.translation.asDiagonal();
    }
    by.middleCols(3 * (std::ssize(group_scale_) + static_cast<Eigen::Index>(j)), 3) = pose[own].rotation;
  }

  /// Of the scales and offsets at which the poses were solved last: J'WJ with the priors, and −½ of the cost's gradient.
  struct NormalEquations {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
  };

  NormalEquations normal_equations() const {
    const Eigen::Index scales = 3 * std::ssize(group_scale_), unknowns = scales + 3 * std::ssize(offsets_);
    NormalEquations all{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
    PoseSolver solver(now_, {.marker_sigma_m = options_.marker_sigma_m});
    for (std::size_t f = 0; f < frames_.size(); ++f) add_frame(solver, f, all.information, all.gradient);
    const double of_scale = options_.scale_sigma > 0 ? 1 / (options_.scale_sigma * options_.scale_sigma) : 1e12;
    for (Eigen::Index u = 0; u < unknowns; ++u) {
      const bool scale = u < scales;
      const double now = scale ? group_scale_[static_cast<std::size_t>(u / 3)][u % 3]
                               : offsets_[static_cast<std::size_t>((u - scales) / 3)][(u - scales) % 3];
      const double sigma = scale ? 0 : offset_sigma(static_cast<std::size_t>((u - scales) / 3)),
                   weight = scale ? of_scale : 1 / (sigma * sigma);
      all.information(u, u) += weight;
      all.gradient[u] += weight * ((scale ? centre_[u] : 0) - now);
    }
    if (options_.tie_sigma_m > 0) tie_twins(scales, all);
    return all;
  }

  /// A left marker's offset is the right one's, mirrored, but for the tie's deviation.
  void tie_twins(Eigen::Index scales, NormalEquations& all) const {
    const double weight = 1 / (options_.tie_sigma_m * options_.tie_sigma_m);
    for (const auto& [left, right] : twins_) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double mirror = axis == across_ ? -1 : 1;
        const Eigen::Index a = scales + 3 * static_cast<Eigen::Index>(left) + axis,
                           b = scales + 3 * static_cast<Eigen::Index>(right) + axis;
        const double apart = offsets_[left][axis] - mirror * offsets_[right][axis];
        all.information(a, a) += weight;
        all.information(b, b) += weight;
        all.information(a, b) -= weight * mirror;
        all.information(b, a) -= weight * mirror;
        all.gradient[a] -= weight * apart;
        all.gradient[b] += weight * mirror * apart;
      }
    }
  }

  /// One Gauss–Newton step of scales and offsets; false where it is small.
  bool improve() {
    const NormalEquations equations = normal_equations();
    const Eigen::VectorXd step = geometry::solve_symmetric(equations.information, equations.gradient);
    for (std::size_t g = 0; g < group_scale_.size(); ++g)
      group_scale_[g] = (group_scale_[g] + step.segment<3>(3 * static_cast<Eigen::Index>(g))).cwiseMax(0.3).cwiseMin(3.0);
    const Eigen::Index scales = 3 * std::ssize(group_scale_);
    for (std::size_t j = 0; j < offsets_.size(); ++j) offsets_[j] += step.segment<3>(scales + 3 * static_cast<Eigen::Index>(j));
    return step.cwiseAbs().maxCoeff() > 1e-5;
  }

  /// Segments of whose size the frames say less than the prior did: the distance to one of the joints (or the end) on it
  /// keeps more than half of its variance; without any, each of its three axes does.
  std::vector<std::string> undetermined(std::vector<std::string>& markers) const {
    const NormalEquations equations = normal_equations();
    const Eigen::MatrixXd covariance = geometry::solve_symmetric(
        equations.information, Eigen::MatrixXd::Identity(equations.gradient.size(), equations.gradient.size()));
    const double prior = options_.scale_sigma * options_.scale_sigma;
    for (std::size_t j = 0; j < offsets_.size(); ++j) {
      const Eigen::Index at = 3 * std::ssize(group_scale_) + 3 * static_cast<Eigen::Index>(j);
      if (covariance.diagonal().segment<3>(at).maxCoeff() > 0.5 * offset_sigma(j) * offset_sigma(j))
        markers.push_back(base_.markers[j].label);
    }
    std::vector<std::string> names;
    for (std::size_t s = 0; s < base_.segments.size(); ++s) {
      const Matrix<3> own = covariance.block<3, 3>(3 * group_of_[s], 3 * group_of_[s]);
      const std::vector<Vector<3>> bones = bones_of(s);
      const bool open = bones.empty() ? own.diagonal().minCoeff() > 0.5 * prior
                                      : std::any_of(bones.begin(), bones.end(), [&](const Vector<3>& bone) {
                                          // A length |s ∘ v| changes with s by s v² / length: v² / |v| where s is near 1.
                                          const Vector<3> by = bone.cwiseProduct(bone) / bone.norm();
                                          return by.dot(own * by) > 0.5 * prior * by.squaredNorm();
                                        });
      if (open) names.push_back(base_.segments[s].name);
    }
    return names;
  }

  /// From the segment's frame to the joints of the segments that hang on it, and to its end; none that is shorter than 1 cm.
  std::vector<Vector<3>> bones_of(std::size_t segment) const {
    constexpr double kMinLength = 0.01;
    std::vector<Vector<3>> bones;
    for (const Segment& other : base_.segments) {
      if (other.parent && static_cast<std::size_t>(*other.parent) == segment)
        bones.push_back(other.joint.parent_from_joint.translation);
    }
    if (base_.segments[segment].end) bones.push_back(*base_.segments[segment].end);
    std::erase_if(bones, [](const Vector<3>& bone) { return bone.norm() < kMinLength; });
    return bones;
  }

  bool stands(const ObservedMarkers& frame) const { return options_.standing && &frame == &*options_.standing; }

  /// Pulls the angles of who stands towards 0; the less, the more the markers contradict (Geman and McClure).
  void add_upright(const Articulation& articulation, const SkeletonState& state, PoseEquations& pose) const {
    const auto sigma = [&](int coordinate) { return options_.standing_sigmas_rad[static_cast<std::size_t>(coordinate)]; };
    std::vector<double> upright = state.coordinates;
    for (std::size_t c = 0; c < upright.size(); ++c) {
      if (options_.standing_sigmas_rad[c] > 0) upright[c] = 0;
    }
    base_.couple(upright);
    Eigen::VectorXd step(articulation.dofs());
    articulation.difference(state, articulation.state_of(std::move(upright)), step);
    for (int d = 0; d < articulation.dofs(); ++d) {
      const Articulation::Dof& dof = articulation.dof()[static_cast<std::size_t>(d)];
      const int coordinate =
          dof.coordinate ? *dof.coordinate
                         : articulation.balls()[static_cast<std::size_t>(dof.ball)].coordinates[static_cast<std::size_t>(dof.part)];
      if (!(sigma(coordinate) > 0)) continue;
      const double off = step[d] / (kContradictedSigmas * sigma(coordinate)), robust = 1 / (1 + off * off);
      const double weight = robust * robust / (sigma(coordinate) * sigma(coordinate));
      pose.information(d, d) += weight;
      pose.gradient[d] += weight * step[d];
    }
  }

  /// Adds what a frame says, its pose eliminated: B − E H⁻¹ Eᵀ. A joint that is held at its limit does not give way to a size.
  void add_frame(PoseSolver& solver, std::size_t frame, Eigen::MatrixXd& information, Eigen::VectorXd& gradient) const {
    const ObservedMarkers& detected = *frames_[frame];
    Articulation& articulation = solver.articulation();
    const int n = articulation.dofs();
    const SkeletonState state = articulation.state_of(poses_[frame]);
    articulation.location(state);
    const auto& pose = articulation.world_from_segment();
    const double sigma = std::hypot(options_.marker_sigma_m, stands(detected) ? 0 : options_.lasting_sigma_m);
    const double weight = 1 / (sigma * sigma);
    Eigen::MatrixXd by_pose = Eigen::MatrixXd::Zero(3, n), by_model(3, gradient.size());
    Eigen::MatrixXd e = Eigen::MatrixXd::Zero(n, gradient.size());
    PoseEquations own_pose{.information = Eigen::MatrixXd::Identity(n, n), .gradient = Eigen::VectorXd::Zero(n)};
    solver.add_limits(state, own_pose);
    if (stands(detected)) add_upright(articulation, state, own_pose);
    Eigen::MatrixXd& h = own_pose.information;
    Eigen::VectorXd& b = own_pose.gradient;
    for (std::size_t j = 0; j < detected.size(); ++j) {
      if (!detected[j]) continue;
      const auto own = static_cast<std::size_t>(now_.markers[j].segment);
      const Vector<3> p = pose[own] * now_.markers[j].position, off = *detected[j] - p;
      by_pose.setZero();
      for (std::optional<int> s = static_cast<int>(own); s; s = base_.segments[static_cast<std::size_t>(*s)].parent) {
        for (const Driver& driver : articulation.drivers(static_cast<std::size_t>(*s)))
          by_pose.col(driver.dof) += driver.shift + driver.turn.cross(p);
      }
      by_model.setZero();
      add_derivatives(j, pose, by_model);
      h.noalias() += weight * by_pose.transpose() * by_pose;
      e.noalias() += weight * by_pose.transpose() * by_model;
      b.noalias() += weight * by_pose.transpose() * off;
      information.noalias() += weight * by_model.transpose() * by_model;
      gradient.noalias() += weight * by_model.transpose() * off;
    }
    const Eigen::LDLT<Eigen::MatrixXd> pose_solver(h);
    information.noalias() -= e.transpose() * pose_solver.solve(e);
    gradient.noalias() -= e.transpose() * pose_solver.solve(b);
  }

  Skeleton base_;
  CalibrateOptions options_;
  std::vector<const ObservedMarkers*> frames_;
  std::vector<int> group_of_;
  std::vector<Vector<3>> group_scale_, offsets_;
  std::vector<double> given_weights_;                       // of the markers, if theirs depend on how loose they are
  std::vector<std::pair<std::size_t, std::size_t>> twins_;  // left, right
  Eigen::Index across_ = 2;
  Eigen::VectorXd centre_;
  Skeleton now_;
  std::vector<std::vector<double>> poses_;
  double rms_ = 0;
};

}  // namespace

Skeleton scaled(const Skeleton& skeleton, std::span<const Vector<3>> scales) {
  Skeleton result = skeleton;
  for (std::size_t s = 0; s < result.segments.size(); ++s) {
    Segment& segment = result.segments[s];
    Joint& joint = segment.joint;
    if (segment.end) segment.end = scales[s].cwiseProduct(*segment.end);
    // joint_from_segment places the joint in the segment: it is there that the scale counts.
    Rigid3 segment_from_joint = joint.joint_from_segment.inverse();
    segment_from_joint.translation = scales[s].cwiseProduct(segment_from_joint.translation);
    joint.joint_from_segment = segment_from_joint.inverse();
    if (!segment.parent) continue;
    const Vector<3>& parent = scales[static_cast<std::size_t>(*segment.parent)];
    joint.parent_from_joint.translation = parent.cwiseProduct(joint.parent_from_joint.translation);
    for (JointAxis& axis : joint.axes) {
      if (!axis.is_rotation)
        axis.amount = axis.amount.times(parent.cwiseProduct(joint.parent_from_joint.rotation * axis.axis).norm());
    }
  }
  for (SkeletonMarker& marker : result.markers)
    marker.position = scales[static_cast<std::size_t>(marker.segment)].cwiseProduct(marker.position);
  return result;
}

Calibration calibrate(const Skeleton& skeleton, std::span<const ObservedMarkers> frames, const CalibrateOptions& options) {
  return Calibrator(skeleton, frames, options).run();
}

}  // namespace marey::solve::skeleton
