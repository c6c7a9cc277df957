// A person's keypoints in space into markers on bony landmarks, and the angles of joints between them, with deviations.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording.h"
#include "marey/format/format.h"
#include "marey/pipeline/keypoints/augmenter_input.h"

namespace marey::pipeline::bodies {

struct AugmentOptions {
  double height_m = 0, mass_kg = 0;  ///< of the person
  std::string person = {};           ///< of several the one: "P2"; empty: the first
  keypoints::HipPoints hips = keypoints::HipPoints::as_networks;
  std::optional<format::UpAxis> up = {};  ///< of the recording; nothing: as it says, else z
};

/// An angle over the recording, one value an instant.
struct AugmentedAngle {
  std::string name;                               ///< "left_hip_flexion", as `analyse::gait::angle_names` has it
  std::vector<std::optional<double>> values;      ///< rad
  std::vector<std::optional<double>> deviations;  ///< rad, one standard deviation; nothing if keypoints have no covariance
};

/// Of an angle over the recording, rad.
struct AngleRange {
  double lowest = 0, highest = 0;
  std::optional<double> deviation;  ///< median
};

/// Nothing if it is nowhere known.
std::optional<AngleRange> range_of(const AugmentedAngle& angle);

struct AugmentedPerson {
  Recording recording;  ///< the 43 markers under OpenCap's labels, with covariances where the keypoints have them
  std::vector<AugmentedAngle> angles;
  std::int64_t frames = 0, augmented = 0;  ///< instants; those with markers
  bool arms = true;
  std::optional<double> marker_deviation_m;  ///< median over markers and instants, of the largest axis
  std::vector<std::string> warnings;
};

/// Throws Error if the recording has no person's keypoints of legs and shoulders, or nowhere half a second of them; and if the
/// networks are not there.
AugmentedPerson augment_markers(const std::string& recording, const AugmentOptions& options, const Hooks& hooks = {});

/// Its markers in the format of the ending of each of `outputs`, and where `angles` is not empty a table of them: CSV, time_s and
/// of each angle its value and its deviation, degrees. Adds to the warnings what a format could not hold.
void write_augmented(AugmentedPerson& person, const std::vector<std::string>& outputs, const std::string& angles);

}  // namespace marey::pipeline::bodies
