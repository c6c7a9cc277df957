#include "marey/pipeline/bodies/calibrate_skeleton.h"

#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/scaled_osim.h"
#include "marey/pipeline/bodies/body_proportions.h"
#include "marey/pipeline/bodies/marker_sigmas.h"
#include "marey/pipeline/bodies/same_person.h"
#include "marey/pipeline/markers/skeleton_in_space.h"

namespace marey::pipeline::bodies {
namespace {

constexpr std::size_t kMaxCalibrationFrames = 4096;

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
  return solve::skeleton::calibrate(skeleton, frames, how);
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
