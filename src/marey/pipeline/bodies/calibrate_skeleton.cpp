#include "marey/pipeline/bodies/calibrate_skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/scaled_osim.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/bodies/body_proportions.h"
#include "marey/pipeline/bodies/gait_markers.h"
#include "marey/pipeline/bodies/marker_sigmas.h"
#include "marey/pipeline/bodies/same_person.h"
#include "marey/pipeline/markers/skeleton_in_space.h"

namespace marey::pipeline::bodies {
namespace {

constexpr std::size_t kMaxCalibrationFrames = 4096;
constexpr double kUpright_rad =
    5 * std::numbers::pi / 180;  // physical: standing people's hips, knees and ankles, one standard deviation
/// Skin carries markers by 10 to 30 mm (Leardini, Chiari, Della Croce, Cappozzo 2005, Gait & Posture 21), alike in every stride:
/// the 60 frames of a calibration count as about six that are 15 mm off each. bench/tuning.md
constexpr double kSkin_m = 0.05;
constexpr double kAnywhere_m = 0.05;  // by definition: as markers of clusters (marker_sigmas.cpp)
/// Coordinates of these joints are near 0 in who stands upright; arms hang as they like.
constexpr std::array<std::string_view, 6> kUprightJoints = {"hip", "knee", "ankle", "subtalar", "mtp", "lumbar"};

/// The markers of all frames, for a calibration.
std::vector<solve::skeleton::ObservedMarkers> all_observed(const std::string& recording, const Skeleton& skeleton,
                                                           const SolveOptions& options) {
  const auto reader = open_markers(recording, options);
  markers::SkeletonMarkers labels(skeleton, options.exclude);
  labels.name(reader->tracks());
  std::vector<solve::skeleton::ObservedMarkers> frames;
  std::size_t step = 1, count = 0;
  while (const auto instant = reader->next()) {
    labels.name(instant->named);
    if (count++ % step != 0) continue;
    solve::skeleton::ObservedMarkers detected;
    labels.take(*instant, detected);
    frames.push_back(std::move(detected));
    if (frames.size() < kMaxCalibrationFrames) continue;
    for (std::size_t i = 0; 2 * i < frames.size(); ++i) frames[i] = std::move(frames[2 * i]);
    frames.resize((frames.size() + 1) / 2);
    step *= 2;
  }
  return frames;
}

std::vector<double> standing_sigmas(const Skeleton& skeleton) {
  std::vector<double> sigmas;
  for (const Coordinate& coordinate : skeleton.coordinates) {
    const bool upright = coordinate.is_rotation &&
                         std::any_of(kUprightJoints.begin(), kUprightJoints.end(),
                                     [&](std::string_view joint) { return coordinate.name.find(joint) != std::string::npos; });
    sigmas.push_back(upright ? kUpright_rad : 0);
  }
  return sigmas;
}

/// The mean of a static trial. Throws Error if half of the markers move.
solve::skeleton::ObservedMarkers standing_markers(const std::vector<solve::skeleton::ObservedMarkers>& frames,
                                                  const std::string& path) {
  solve::skeleton::ObservedMarkers means(frames.empty() ? 0 : frames.front().size());
  std::vector<double> moved;
  for (std::size_t j = 0; j < means.size(); ++j) {
    Vector<3> sum = Vector<3>::Zero();
    int count = 0;
    for (const auto& frame : frames) {
      if (!frame[j]) continue;
      sum += *frame[j];
      ++count;
    }
    if (count == 0) continue;
    means[j] = sum / count;
    moved.push_back(0);
    for (const auto& frame : frames) {
      if (frame[j]) moved.back() = std::max(moved.back(), (*frame[j] - *means[j]).norm());
    }
  }
  if (moved.empty()) throw Error("{}: none of the skeleton's markers is seen in the static trial", path);
  if (const double typical = geometry::median(moved); typical > kStandsStillM)
    throw Error("{}: markers move by {:.0f} mm; a static trial is of a person who stands still", path, 1000 * typical);
  return means;
}

/// Markers that were put on again for the motion, or slide on the segment, do not count in the static trial, and their places are
/// the motion's alone. Where most are elsewhere, the static trial is another person's.
void exclude_moved(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> frames,
                   std::span<const solve::skeleton::ObservedMarkers> standing, const std::string& recording,
                   const std::string& path, solve::skeleton::CalibrateOptions& how, std::vector<std::string>& warnings) {
  const auto differs = other_size(skeleton, frames, standing);
  if (!differs) return;
  const std::vector<std::size_t> moved = moved_markers(skeleton, frames, standing);
  const auto seen = static_cast<std::size_t>(
      std::count_if(how.standing->begin(), how.standing->end(), [](const auto& marker) { return marker.has_value(); }));
  if (3 * moved.size() > seen) {
    how.standing.reset();
    warnings.push_back(fmt::format("{}: {} than in {}: another person's static trial? It is not used", path, *differs, recording));
    return;
  }
  std::vector<std::string> labels;
  for (const std::size_t marker : moved) {
    (*how.standing)[marker].reset();
    how.offset_sigmas_m[marker] = kAnywhere_m;
    labels.push_back(skeleton.markers[marker].label);
  }
  warnings.push_back(fmt::format("{}: {} than in {}: were markers put on again? Of the static trial {} {} not used", path, *differs,
                                 recording, fmt::join(labels, ", "), labels.size() == 1 ? "is" : "are"));
}

/// Who stands otherwise than upright: the coordinate that is farthest from 0, if that is more than the prior allows.
std::optional<std::string> posture_of(const Skeleton& skeleton, const std::vector<double>& standing,
                                      const std::vector<double>& sigmas) {
  std::optional<std::size_t> worst;
  for (std::size_t c = 0; c < sigmas.size(); ++c) {
    if (!(sigmas[c] > 0) || std::abs(standing[c]) < 4 * sigmas[c]) continue;
    if (!worst || std::abs(standing[c]) > std::abs(standing[*worst])) worst = c;
  }
  if (!worst) return std::nullopt;
  return fmt::format("{} is {:.0f}° in the static trial; does the person stand in a crouch, or is that how they stand?",
                     skeleton.coordinates[*worst].name, standing[*worst] * 180 / std::numbers::pi);
}

/// Where the mass does not fit a person of the model's height, as its legs have it.
std::optional<std::string> implausible_mass(const Skeleton& skeleton, double mass_kg) {
  const std::vector<Rigid3> rest = pose_of(skeleton, skeleton.rest());
  const auto origin = [&](const char* name) -> std::optional<Vector<3>> {
    const auto segment = skeleton.segment(name);
    return segment ? std::optional(rest[static_cast<std::size_t>(*segment)].translation) : std::nullopt;
  };
  const auto hip = origin("femur_r"), knee = origin("tibia_r"), ankle = origin("talus_r");
  if (!hip || !knee || !ankle) return std::nullopt;
  const double height = height_of_legs((*hip - *knee).norm() + (*knee - *ankle).norm()), index = body_mass_index(mass_kg, height);
  if (is_persons_index(index)) return std::nullopt;
  return fmt::format(
      "--mass {:g} kg is not a person's whose legs are as long as the calibrated model's, about {:.2f} m tall (body mass index "
      "{:.1f}); "
      "is it in kilograms?",
      mass_kg, height, index);
}

}  // namespace

std::unique_ptr<format::FileReader> open_markers(const std::string& path, const SolveOptions& options) {
  const format::Format& format = format::format_to_read(path, format::Content::space);
  format::ReadOptions how;
  how.up = options.up;
  auto reader = format::open_recording(path, format, how);
  if (reader->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: holds no points in space; a skeleton is solved from markers in space", path);
  return reader;
}

solve::skeleton::Calibration calibrate_skeleton(const std::string& recording, const Skeleton& skeleton, bool generic,
                                                const SolveOptions& options, std::vector<std::string>& warnings) {
  std::vector<solve::skeleton::ObservedMarkers> frames = all_observed(recording, skeleton, options);
  const std::size_t own = frames.size();
  for (const std::string& take : options.calibration_takes) {
    std::vector<solve::skeleton::ObservedMarkers> more = all_observed(take, skeleton, options);
    if (const auto differs = other_size(skeleton, std::span(frames).first(own), more))
      warnings.push_back(
          fmt::format("{}: {} than in {}: another person, or markers that were put on again? A calibration is of one", take,
                      *differs, recording));
    frames.insert(frames.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  solve::skeleton::CalibrateOptions how;
  if (generic) {
    how.offset_sigmas_m = marker_sigmas(skeleton);
    how.tie_sigma_m = 0.01;  // unswept
  }
  if (generic && !options.static_trial.empty()) {
    const auto standing = all_observed(options.static_trial, skeleton, options);
    how.standing = standing_markers(standing, options.static_trial);
    how.standing_sigmas_rad = standing_sigmas(skeleton);
    exclude_moved(skeleton, frames, standing, recording, options.static_trial, how, warnings);
  }
  // Without a static trial it leaves too much open: gait2354 gets worse by 4°.
  if (how.standing) how.lasting_sigma_m = kSkin_m;
  solve::skeleton::Calibration calibration = solve::skeleton::calibrate(skeleton, frames, how);
  if (how.standing) {
    if (const auto posture = posture_of(skeleton, calibration.standing, how.standing_sigmas_rad))
      warnings.push_back(fmt::format("{}: {}", options.static_trial, *posture));
  }
  return calibration;
}

void write_skeleton_file(const std::string& source, const SolvedRecording& solved, const SolveOptions& options,
                         std::vector<std::string>& warnings) {
  const std::string& path = options.write_skeleton;
  std::string text;
  if (path.ends_with(".osim")) {
    if (!source.ends_with(".osim"))
      throw Error("{}: an .osim is written of an OpenSim model alone; give it by --skeleton, or write .toml", path);
    const std::vector<Vector<3>> alike(solved.skeleton.segments.size(), Vector<3>::Ones());
    format::skeleton::ScaledOsim scaled = format::skeleton::scaled_osim(
        format::read_file(source), source, solved.skeleton, solved.scales.empty() ? alike : solved.scales, options.mass_kg);
    warnings.insert(warnings.end(), scaled.warnings.begin(), scaled.warnings.end());
    if (auto implausible = options.mass_kg ? implausible_mass(solved.skeleton, *options.mass_kg) : std::nullopt)
      warnings.push_back(std::move(*implausible));
    text = std::move(scaled.text);
  } else {
    text = format::skeleton::to_toml(solved.skeleton);
  }
  WholeFile file(path);
  file.write(text);
  file.finish();
}

}  // namespace marey::pipeline::bodies
