#include "marey/pipeline/keypoints/marker_augmenter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "marey/core/error.h"
#include "marey/detect/network/onnx_graph.h"
#include "marey/format/read_file.h"

namespace marey::pipeline::keypoints {
namespace {

using detect::network::LstmNetwork;

constexpr std::size_t kHeadings = 8;           // numerical: in steps of 45°
constexpr std::size_t kDraws = 2 * kHeadings;  // numerical: a deviation of 16 values is known to 18 %
constexpr std::size_t kStepsAtOnce = 128;      // numerical: bounds memory
// Errors of simulated keypoints in space: bench/tuning.md.
constexpr double kLastingFraction = 0.53;                     // of their variance that stays over seconds: a point's bias
constexpr double kErrorTime_s = 0.1;                          // after which the rest has fallen to 1 / e
constexpr std::size_t kHip = 1;                               // by definition of kAugmenterPoints
constexpr std::array<std::size_t, 3> kArmInputs = {0, 7, 8};  // shoulders, elbows, wrists
constexpr Eigen::Index kLegFeatures = 47, kArmFeatures = 23;  // format: of the networks

constexpr std::array<AugmentedMarker, kAugmentedMarkers> kMarkersMade = {{{"r.ASIS_study", "right_asis"},
                                                                          {"L.ASIS_study", "left_asis"},
                                                                          {"r.PSIS_study", "right_psis"},
                                                                          {"L.PSIS_study", "left_psis"},
                                                                          {"r_knee_study", "right_knee_lateral"},
                                                                          {"r_mknee_study", "right_knee_medial"},
                                                                          {"r_ankle_study", "right_ankle_lateral"},
                                                                          {"r_mankle_study", "right_ankle_medial"},
                                                                          {"r_toe_study", "right_toe"},
                                                                          {"r_5meta_study", "right_meta"},
                                                                          {"r_calc_study", "right_heel"},
                                                                          {"L_knee_study", "left_knee_lateral"},
                                                                          {"L_mknee_study", "left_knee_medial"},
                                                                          {"L_ankle_study", "left_ankle_lateral"},
                                                                          {"L_mankle_study", "left_ankle_medial"},
                                                                          {"L_toe_study", "left_toe"},
                                                                          {"L_calc_study", "left_heel"},
                                                                          {"L_5meta_study", "left_meta"},
                                                                          {"r_shoulder_study", "right_shoulder"},
                                                                          {"L_shoulder_study", "left_shoulder"},
                                                                          {"C7_study", ""},
                                                                          {"r_thigh1_study", ""},
                                                                          {"r_thigh2_study", ""},
                                                                          {"r_thigh3_study", ""},
                                                                          {"L_thigh1_study", ""},
                                                                          {"L_thigh2_study", ""},
                                                                          {"L_thigh3_study", ""},
                                                                          {"r_sh1_study", ""},
                                                                          {"r_sh2_study", ""},
                                                                          {"r_sh3_study", ""},
                                                                          {"L_sh1_study", ""},
                                                                          {"L_sh2_study", ""},
                                                                          {"L_sh3_study", ""},
                                                                          {"RHJC_study", "right_hip_centre"},
                                                                          {"LHJC_study", "left_hip_centre"},
                                                                          {"r_lelbow_study", "right_elbow_lateral"},
                                                                          {"r_melbow_study", "right_elbow_medial"},
                                                                          {"r_lwrist_study", "right_wrist_lateral"},
                                                                          {"r_mwrist_study", "right_wrist_medial"},
                                                                          {"L_lelbow_study", "left_elbow_lateral"},
                                                                          {"L_melbow_study", "left_elbow_medial"},
                                                                          {"L_lwrist_study", "left_wrist_lateral"},
                                                                          {"L_mwrist_study", "left_wrist_medial"}}};

LstmNetwork read_network(const std::string& path, Eigen::Index features, std::size_t markers) {
  const auto graph = detect::network::onnx_graph(format::read_file(path));
  constexpr const char* kRemade = "make it again with script/model --augmenter";
  if (!graph) throw Error("{}: cannot be read as a network; {}", path, kRemade);
  LstmNetwork network(*graph, path);
  if (network.features() != features || network.outputs() != static_cast<Eigen::Index>(3 * markers))
    throw Error("{}: is another network than OpenCap's marker augmenter; {}", path, kRemade);
  return network;
}

/// Where the person faces on the whole, rad about z; 0 if that is nowhere.
double facing_of(const AugmenterRun& run) {
  Vector<2> sum = Vector<2>::Zero();
  for (const AugmenterStep& step : run.steps) {
    const Vector<3> to_left = step.position[2 * kHip + 1] - step.position[2 * kHip];
    sum += Vector<2>(to_left.y(), -to_left.x());
  }
  return sum.norm() > 0 ? std::atan2(sum.y(), sum.x()) : 0;
}

/// Errors of keypoints: a part that stays, and one that changes from step to step.
class DrawnErrors {
 public:
  DrawnErrors(std::size_t draws, std::uint64_t seed) : random_(seed), lasting_(draws), passing_(draws) {
    for (std::size_t d = 0; d < draws; ++d) {
      for (Vector<3>& error : lasting_[d]) error = standard();
      for (Vector<3>& error : passing_[d]) error = standard();
    }
  }

  void advance() {
    const double kept = std::exp(-1 / (kAugmenterRate_hz * kErrorTime_s)), fresh = std::sqrt(1 - kept * kept);
    for (auto& draw : passing_) {
      for (Vector<3>& error : draw) error = kept * error + fresh * standard();
    }
  }

  AugmenterStep drawn(const AugmenterStep& step, std::size_t draw) const {
    AugmenterStep made = step;
    for (std::size_t i = 0; i < step.position.size(); ++i) {
      const Eigen::LLT<Matrix<3>> root(step.covariance[i]);
      const Vector<3> error = std::sqrt(kLastingFraction) * lasting_[draw][i] + std::sqrt(1 - kLastingFraction) * passing_[draw][i];
      if (root.info() == Eigen::Success) made.position[i] += root.matrixL() * error;
    }
    return made;
  }

 private:
  using Errors = std::array<Vector<3>, 2 * kAugmenterPoints.size()>;

  Vector<3> standard() {
    const double x = normal_(random_), y = normal_(random_), z = normal_(random_);
    return {x, y, z};
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<Errors> lasting_, passing_;
};

/// What both networks are asked at one step and sequence. Their y is up: (x, y, z) here is (x, z, −y) there.
class Question {
 public:
  Question(const AugmenterPerson& person, double turn)
      : person_(person), rotation_(Eigen::AngleAxisd(turn, Vector<3>::UnitZ()).toRotationMatrix()) {}

  void legs(const AugmenterStep& step, Eigen::Ref<Eigen::VectorXf> column) const {
    Filler fill{.question = *this, .hips = hips_of(step), .column = column, .at = 0};
    fill.point(0.5 * (step.position[0] + step.position[1]));
    for (std::size_t i = 0; i < 2 * kLegPoints; ++i) fill.point(step.position[i]);
    fill.person();
  }
  void arms(const AugmenterStep& step, Eigen::Ref<Eigen::VectorXf> column) const {
    Filler fill{.question = *this, .hips = hips_of(step), .column = column, .at = 0};
    fill.point(0.5 * (step.position[0] + step.position[1]));
    for (const std::size_t point : kArmInputs) {
      fill.point(step.position[2 * point]);
      fill.point(step.position[2 * point + 1]);
    }
    fill.person();
  }
  /// Back from a network's answer.
  Vector<3> position(const Eigen::Vector3f& answer, const Vector<3>& hips) const {
    const Vector<3> made = person_.height_m * answer.cast<double>();
    return rotation_.transpose() * Vector<3>(made.x(), -made.z(), made.y()) + hips;
  }

 private:
  struct Filler {
    const Question& question;
    Vector<3> hips;
    Eigen::Ref<Eigen::VectorXf> column;
    Eigen::Index at;

    void point(const Vector<3>& location) {
      const Vector<3> from = question.rotation_ * (location - hips) / question.person_.height_m;
      column.segment<3>(at) = Vector<3>(from.x(), from.z(), -from.y()).cast<float>();
      at += 3;
    }
    void person() {
      column[at++] = static_cast<float>(question.person_.height_m);
      column[at++] = static_cast<float>(question.person_.mass_kg);
    }
  };

  AugmenterPerson person_;
  Matrix<3> rotation_;
};

/// The sequences that the networks are asked: the motion in all headings, then the same with drawn errors; a column a step and
/// sequence, the sequences of a step together.
class Sequences {
 public:
  Sequences(const AugmenterRun& run, const AugmenterPerson& person, bool arms, bool covariances, std::uint64_t seed)
      : arms_(arms), draws_(covariances ? kDraws : 0), errors_(draws_, seed) {
    const double facing = facing_of(run);
    for (std::size_t s = 0; s < size(); ++s)
      questions_.emplace_back(person, 2 * std::numbers::pi * static_cast<double>(s % kHeadings) / kHeadings - facing);
  }

  std::size_t size() const { return kHeadings + draws_; }
  const Eigen::MatrixXf& legs() const { return legs_; }
  const Eigen::MatrixXf& arms() const { return hands_; }

  /// In the place of those before.
  void set_inputs(std::span<const AugmenterStep> steps) {
    const auto columns = static_cast<Eigen::Index>(steps.size() * size());
    legs_.resize(kLegFeatures, columns);
    hands_.resize(kArmFeatures, arms_ ? columns : 0);
    inputs_.clear();
    for (const AugmenterStep& step : steps) {
      for (std::size_t s = 0; s < size(); ++s) {
        const auto column = static_cast<Eigen::Index>(inputs_.size());
        inputs_.push_back(s < kHeadings ? step : errors_.drawn(step, s - kHeadings));
        questions_[s].legs(inputs_.back(), legs_.col(column));
        if (arms_) questions_[s].arms(inputs_.back(), hands_.col(column));
      }
      errors_.advance();
    }
  }

  /// Of the step of that number among those that were asked.
  AugmentedStep answer(std::size_t step, const Eigen::MatrixXf& legs, const Eigen::MatrixXf& arms) const {
    AugmentedStep made;
    made.mean.fill(Vector<3>::Zero());
    made.shoulders = {inputs_[step * size()].position[0], inputs_[step * size()].position[1]};
    for (std::size_t s = 0; s < size(); ++s) {
      const std::size_t column = step * size() + s;
      const AugmentedStep::Markers markers = markers_at(column, legs, arms);
      if (s < kHeadings) {
        for (std::size_t m = 0; m < kAugmentedMarkers; ++m) made.mean[m] += markers[m] / kHeadings;
        continue;
      }
      made.draws.push_back(markers);
      made.drawn_shoulders.push_back({inputs_[column].position[0], inputs_[column].position[1]});
    }
    return made;
  }

 private:
  AugmentedStep::Markers markers_at(std::size_t column, const Eigen::MatrixXf& legs, const Eigen::MatrixXf& arms) const {
    AugmentedStep::Markers markers;
    markers.fill(Vector<3>::Zero());
    const Vector<3> hips = hips_of(inputs_[column]);
    for (std::size_t m = 0; m < (arms_ ? kAugmentedMarkers : kLegMarkers); ++m) {
      const bool leg = m < kLegMarkers;
      const auto row = static_cast<Eigen::Index>(3 * (leg ? m : m - kLegMarkers));
      const Eigen::Vector3f found = (leg ? legs : arms).block<3, 1>(row, static_cast<Eigen::Index>(column));
      markers[m] = questions_[column % size()].position(found, hips);
    }
    return markers;
  }

  bool arms_;
  std::size_t draws_;
  DrawnErrors errors_;
  std::vector<Question> questions_;
  std::vector<AugmenterStep> inputs_;
  Eigen::MatrixXf legs_, hands_;
};

}  // namespace

std::span<const AugmentedMarker> augmented_markers() {
  return kMarkersMade;
}

MarkerAugmenter::MarkerAugmenter(const std::string& lower, const std::string& upper)
    : lower_(read_network(lower, kLegFeatures, kLegMarkers)),
      upper_(read_network(upper, kArmFeatures, kAugmentedMarkers - kLegMarkers)) {}

void MarkerAugmenter::augment(const AugmenterRun& run, const AugmenterPerson& person, bool arms, bool covariances,
                              std::uint64_t seed,
                              const std::function<void(std::size_t step, const AugmentedStep& made)>& take) const {
  Sequences sequences(run, person, arms, covariances, seed);
  const auto count = static_cast<Eigen::Index>(sequences.size());
  LstmNetwork::State legs = lower_.start(count), hands = upper_.start(count);
  const std::span<const AugmenterStep> all(run.steps);
  for (std::size_t first = 0; first < all.size(); first += kStepsAtOnce) {
    const auto part = all.subspan(first, std::min(kStepsAtOnce, all.size() - first));
    sequences.set_inputs(part);
    const Eigen::MatrixXf leg_markers = lower_.run(sequences.legs(), legs);
    const Eigen::MatrixXf arm_markers = arms ? upper_.run(sequences.arms(), hands) : Eigen::MatrixXf();
    for (std::size_t k = 0; k < part.size(); ++k) take(first + k, sequences.answer(k, leg_markers, arm_markers));
  }
}

}  // namespace marey::pipeline::keypoints
