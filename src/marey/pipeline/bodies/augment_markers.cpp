#include "marey/pipeline/bodies/augment_markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/analyse/gait/anatomical_pose.h"
#include "marey/analyse/gait/joint_angles.h"
#include "marey/core/error.h"
#include "marey/detect/keypoints/model_folder.h"
#include "marey/files/whole_file.h"
#include "marey/format/input_hash.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/bodies/body_proportions.h"
#include "marey/pipeline/keypoints/augmenter_input.h"
#include "marey/pipeline/keypoints/marker_augmenter.h"

namespace marey::pipeline::bodies {
namespace {

using analyse::gait::MarkerPositions;
using keypoints::AugmentedStep;
using keypoints::AugmenterInput;
using keypoints::AugmenterRun;
using keypoints::kAugmentedMarkers;

constexpr std::size_t kMinSteps = 30;                        // half a second at 60 Hz: bench/tuning.md
constexpr double kMinWalk_m = 0.3;                           // in a second: a slower person has no direction: bench/tuning.md
constexpr double kMaxOtherHeight = 0.15;                     // physical: three deviations of people's proportions
constexpr double kDegreesOfRadian = 180 / std::numbers::pi;  // by definition
constexpr std::uint64_t kSeedOfDraws = 1;                    // numerical

/// Pelvis, trunk and the whole foot are stated against the direction of walking.
bool against_walking(const std::string& name) {
  return name.find("_pelvis_") != std::string::npos || name.find("_trunk_") != std::string::npos ||
         name.find("_foot_") != std::string::npos;
}

/// A foot's markers lie in a line nearly: how it turns about that is not seen.
bool not_in_markers(const std::string& name) {
  return name.ends_with("_ankle_inversion") || name.ends_with("_foot_roll");
}

MarkerPositions landmarks_of(const AugmentedStep::Markers& markers, const AugmentedStep::Shoulders& shoulders, bool arms) {
  MarkerPositions positions;
  const auto all = keypoints::augmented_markers();
  for (std::size_t m = 0; m < (arms ? kAugmentedMarkers : keypoints::kLegMarkers); ++m) {
    if (!all[m].landmark.empty()) positions.emplace(all[m].landmark, markers[m]);
  }
  positions.emplace("right_shoulder_joint", shoulders[0]);
  positions.emplace("left_shoulder_joint", shoulders[1]);
  return positions;
}

/// Where the person walks to at a step; 0 if they stand.
Vector<2> walking_at(const AugmenterRun& run, std::size_t step) {
  constexpr auto kAround = static_cast<std::size_t>(keypoints::kAugmenterRate_hz / 2);
  const auto& before = run.steps[step - std::min(step, kAround)];
  const auto& after = run.steps[std::min(step + kAround, run.steps.size() - 1)];
  const Vector<2> moved = (keypoints::hips_of(after) - keypoints::hips_of(before)).head<2>();
  return moved.norm() < kMinWalk_m ? Vector<2>(Vector<2>::Zero()) : moved;
}

/// The result at one step: markers from the middle of the hips, angles by name.
struct StepResult {
  AugmentedStep::Markers offsets;
  std::array<Matrix<3>, kAugmentedMarkers> covariances;
  std::vector<std::optional<double>> angles, deviations;  // rad
};

std::vector<std::optional<double>> angles_at(const AugmentedStep::Markers& markers, const AugmentedStep::Shoulders& shoulders,
                                             bool arms, const Vector<2>& walking) {
  const auto pose = analyse::gait::anatomical_pose(landmarks_of(markers, shoulders, arms));
  auto angles = analyse::gait::angles_of(pose, walking);
  const auto names = analyse::gait::angle_names();
  for (std::size_t a = 0; a < angles.size(); ++a) {
    if ((walking.isZero() && against_walking(names[a])) || not_in_markers(names[a])) angles[a] = std::nullopt;
  }
  return angles;
}

StepResult result_of(const AugmentedStep& made, const AugmenterRun& run, std::size_t step, bool arms) {
  StepResult result;
  const Vector<3> hips = keypoints::hips_of(run.steps[step]);
  const Vector<2> walking = walking_at(run, step);
  result.angles = angles_at(made.mean, made.shoulders, arms, walking);
  result.deviations.resize(result.angles.size());
  for (std::size_t m = 0; m < kAugmentedMarkers; ++m) result.offsets[m] = made.mean[m] - hips;
  const auto draws = static_cast<double>(made.draws.size());
  std::vector<double> squares(result.angles.size(), 0.0), known(result.angles.size(), 0.0);
  result.covariances.fill(Matrix<3>::Zero());
  for (std::size_t d = 0; d < made.draws.size(); ++d) {
    for (std::size_t m = 0; m < kAugmentedMarkers; ++m) {
      const Vector<3> error = made.draws[d][m] - made.mean[m];
      result.covariances[m] += error * error.transpose() / draws;
    }
    const auto drawn = angles_at(made.draws[d], made.drawn_shoulders[d], arms, walking);
    for (std::size_t a = 0; a < drawn.size(); ++a) {
      if (!drawn[a] || !result.angles[a]) continue;
      const double error = std::remainder(*drawn[a] - *result.angles[a], 2 * std::numbers::pi);
      squares[a] += error * error;
      known[a] += 1;
    }
  }
  for (std::size_t a = 0; a < squares.size(); ++a) {
    if (known[a] > 0) result.deviations[a] = std::sqrt(squares[a] / known[a]);
  }
  return result;
}

std::optional<double> blend(const std::optional<double>& a, const std::optional<double>& b, double fraction) {
  if (!a || !b) return fraction < 0.5 ? a : b;
  return *a + fraction * std::remainder(*b - *a, 2 * std::numbers::pi);
}

/// A run's steps at the recording's own instants.
class RunWriter {
 public:
  RunWriter(AugmentedPerson& person, std::vector<TrackColumns>& tracks, const Recording& source, bool covariances)
      : person_(person), tracks_(tracks), source_(source), covariances_(covariances) {}

  void write(const AugmenterRun& run, const std::vector<StepResult>& steps, std::vector<double>& deviations) {
    for (std::size_t t = run.first; t <= run.last; ++t) {
      const double at = (source_.seconds_at(t) - run.begin_s) * keypoints::kAugmenterRate_hz;
      const std::size_t low = std::min(static_cast<std::size_t>(std::max(at, 0.0)), steps.size() - 1),
                        high = std::min(low + 1, steps.size() - 1);
      const double fraction = high > low ? std::clamp(at - static_cast<double>(low), 0.0, 1.0) : 0;
      for (std::size_t m = 0; m < tracks_.size(); ++m) {
        Sample sample;
        sample.provenance = Provenance::solved;
        sample.position = run.hips[t - run.first] + (1 - fraction) * steps[low].offsets[m] + fraction * steps[high].offsets[m];
        if (covariances_) {
          sample.covariance = (1 - fraction) * steps[low].covariances[m] + fraction * steps[high].covariances[m];
          deviations.push_back(
              std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix<3>>(*sample.covariance, Eigen::EigenvaluesOnly).eigenvalues()[2]));
        }
        tracks_[m].add(static_cast<std::int32_t>(t), sample);
      }
      for (std::size_t a = 0; a < person_.angles.size(); ++a) {
        AugmentedAngle& angle = person_.angles[a];
        angle.values[t] = blend(steps[low].angles[a], steps[high].angles[a], fraction);
        if (angle.values[t]) angle.deviations[t] = blend(steps[low].deviations[a], steps[high].deviations[a], fraction);
      }
    }
  }

 private:
  AugmentedPerson& person_;
  std::vector<TrackColumns>& tracks_;
  const Recording& source_;
  bool covariances_;
};

/// What stands before the labels of the one who is wanted. Throws Error if there is none.
std::string chosen_person(const std::string& recording, const std::vector<TrackName>& tracks, const AugmentOptions& options,
                          std::vector<std::string>& warnings) {
  const std::vector<std::string> people = keypoints::people_to_augment(tracks);
  if (people.empty())
    throw Error(
        "{}: has no body keypoints of legs and shoulders (left_shoulder, left_hip, left_knee, left_ankle, left_heel, left_big_toe "
        "and "
        "the right ones); marey reconstruct --targets keypoints makes them",
        recording);
  if (options.person.empty()) {
    if (people.size() > 1)
      warnings.push_back(
          fmt::format("{}: has keypoints of {} people; the first is used, the others with --person", recording, people.size()));
    return people.front();
  }
  for (const std::string& prefix : people) {
    if (prefix == options.person + ":") return prefix;
  }
  throw Error("{}: has no keypoints of legs and shoulders of a person {}", recording, options.person);
}

/// A file that script/model --augmenter makes.
std::string augmenter_file(const char* name) {
  try {
    return detect::keypoints::model_file(name);
  } catch (const Error&) {
    throw Error("the network {} is not there; script/model --augmenter makes it (MAREY_MODELS names another folder)", name);
  }
}

/// What is doubtful of height and mass.
void check_person(const AugmenterInput& input, const AugmentOptions& options, std::vector<std::string>& warnings) {
  std::vector<double> legs;
  for (const AugmenterRun& run : input.runs) {
    for (const auto& step : run.steps) {
      for (std::size_t side = 0; side < 2; ++side)
        legs.push_back((step.position[2 + side] - step.position[4 + side]).norm() +
                       (step.position[4 + side] - step.position[6 + side]).norm());
    }
  }
  const double as_tall = height_of_legs(geometry::median(legs));
  if (std::abs(as_tall / options.height_m - 1) > kMaxOtherHeight)
    warnings.push_back(fmt::format(
        "the legs are as long as those of a person of {:.2f} m, and --height says {:.2f} m: is the height right, and the "
        "rig's scale?",
        as_tall, options.height_m));
  const double index = body_mass_index(options.mass_kg, options.height_m);
  if (!is_persons_index(index))
    warnings.push_back(fmt::format("{:g} kg at a height of {:.2f} m are not a person's (body mass index {:.1f})", options.mass_kg,
                                   options.height_m, index));
}

void check_input(const AugmenterInput& input, const std::string& recording, std::vector<std::string>& warnings) {
  if (!input.missing.empty()) throw Error("{}: never has {} on both sides", recording, fmt::join(input.missing, ", "));
  if (input.runs.empty())
    throw Error("{}: nowhere has half a second in which shoulders, hips, knees, ankles, heels and big toes are all known",
                recording);
  if (!input.arms)
    warnings.push_back(fmt::format("{}: elbows and wrists are barely ever known: markers of the arms are omitted", recording));
  if (!input.small_toes)
    warnings.push_back(fmt::format("{}: has no small toes; they are placed on the feet as OpenPose has them", recording));
  if (!input.covariances)
    warnings.push_back(fmt::format("{}: keypoints have no covariances, so markers and angles have no deviations", recording));
}

AugmentedPerson augment(const Recording& source, const std::string& name, const AugmentOptions& options, const Hooks& hooks) {
  AugmentedPerson person;
  std::vector<TrackName> names;
  for (const TrackColumns& track : source.tracks()) names.push_back(track.name);
  const std::string prefix = chosen_person(name, names, options, person.warnings);
  const AugmenterInput input = keypoints::augmenter_input(source, prefix, options.hips, kMinSteps);
  check_input(input, name, person.warnings);
  check_person(input, options, person.warnings);
  const keypoints::MarkerAugmenter augmenter(augmenter_file("augmenter_lower.onnx"), augmenter_file("augmenter_upper.onnx"));
  person.frames = std::ssize(source.instants());
  person.augmented = static_cast<std::int64_t>(input.instants);
  person.arms = input.arms;
  for (const std::string& angle : analyse::gait::angle_names())
    person.angles.push_back({angle, std::vector<std::optional<double>>(source.instants().size()),
                             std::vector<std::optional<double>>(source.instants().size())});
  person.recording.header = source.header;
  person.recording.header.bodies.clear();
  person.recording.header.keypoints.reset();
  person.recording.header.track_kind = TrackKind::marker;
  for (const auto& instant : source.instants()) person.recording.add_time_step(instant);
  std::vector<TrackColumns> tracks;
  for (std::size_t m = 0; m < (input.arms ? kAugmentedMarkers : keypoints::kLegMarkers); ++m) {
    TrackName track{
        .id = TrackId{static_cast<std::int32_t>(m + 1)}, .label = std::string(keypoints::augmented_markers()[m].label), .team = {}};
    track.kind = TrackKind::marker;
    tracks.emplace_back(track, 3);
  }
  RunWriter writer(person, tracks, source, input.covariances);
  std::vector<double> deviations;
  std::int64_t done = 0, total = 0;
  for (const AugmenterRun& run : input.runs) total += std::ssize(run.steps);
  for (const AugmenterRun& run : input.runs) {
    std::vector<StepResult> steps;
    augmenter.augment(run, {options.height_m, options.mass_kg}, input.arms, input.covariances, kSeedOfDraws,
                      [&](std::size_t step, const AugmentedStep& made) {
                        steps.push_back(result_of(made, run, step, input.arms));
                        hooks.advance({.step = "augmenting", .done = ++done, .total = total});
                      });
    writer.write(run, steps, deviations);
  }
  for (AugmentedAngle& angle : person.angles) analyse::gait::unwrap(angle.values);
  for (TrackColumns& track : tracks) person.recording.put(std::move(track));
  if (!deviations.empty()) person.marker_deviation_m = geometry::median(deviations);
  return person;
}

void write_augmented_angles(const std::string& path, const AugmentedPerson& person) {
  std::string text = "time_s";
  for (const AugmentedAngle& angle : person.angles) fmt::format_to(std::back_inserter(text), ",{0},{0}_deviation", angle.name);
  text += '\n';
  for (std::size_t t = 0; t < person.recording.instants().size(); ++t) {
    fmt::format_to(std::back_inserter(text), "{:.6g}", person.recording.seconds_at(t));
    for (const AugmentedAngle& angle : person.angles) {
      for (const auto& value : {angle.values[t], angle.deviations[t]})
        text += value ? fmt::format(",{:.4f}", *value * kDegreesOfRadian) : ",";
    }
    text += '\n';
  }
  WholeFile file(path);
  file.write(text);
  file.finish();
}

}  // namespace

std::optional<AngleRange> range_of(const AugmentedAngle& angle) {
  std::vector<double> values, deviations;
  for (const auto& value : angle.values) {
    if (value) values.push_back(*value);
  }
  for (const auto& deviation : angle.deviations) {
    if (deviation) deviations.push_back(*deviation);
  }
  if (values.empty()) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return AngleRange{*lowest, *highest, deviations.empty() ? std::nullopt : std::optional(geometry::median(deviations))};
}

AugmentedPerson augment_markers(const std::string& recording, const AugmentOptions& options, const Hooks& hooks) {
  const format::Format& format = format::format_to_read(recording, format::Content::space);
  format::ReadOptions how;
  how.up = options.up;
  const auto reader = format::open_recording(recording, format, how);
  if (reader->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: holds no points in space; keypoints in space are made by marey reconstruct --targets keypoints", recording);
  const Recording source = read_all(*reader);
  AugmentedPerson person = augment(source, recording, options, hooks);
  for (const std::string& warning : reader->warnings()) person.warnings.push_back(warning);
  person.recording.header.made_by = {.program = "marey augment", .options = hooks.options, .inputs = {format::input_of(recording)}};
  return person;
}

void write_augmented(AugmentedPerson& person, const std::vector<std::string>& outputs, const std::string& angles) {
  for (const std::string& output : outputs) {
    const auto sink = format::create_recording(output, format::format_to_write(output, {}, format::Content::space),
                                               format::plan_of(*format::reader_of(person.recording), output), &person.warnings);
    MemoryReader reader(person.recording);
    replay(reader, *sink);
  }
  if (!angles.empty()) write_augmented_angles(angles, person);
}

}  // namespace marey::pipeline::bodies
