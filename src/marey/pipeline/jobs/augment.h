// `marey augment` as a value: a person's body keypoints in space into anatomical markers.
#pragma once

#include <optional>
#include <string>

#include "marey/pipeline/bodies/augment_markers.h"
#include "marey/pipeline/jobs/option.h"

namespace marey::pipeline::jobs {

struct Augment {
  std::optional<double> height_m = {}, mass_kg = {};
  std::string angles = {};              ///< a file; empty: none
  std::string hips = "keypoints";       ///< keypoints or joints
  std::string up = {};                  ///< y or z; empty: as the recording states
  bodies::AugmentOptions options = {};  ///< rows without dependent defaults are bound to these
};

Table table_of(Augment& job);

/// Throws WrongOption if the height or the mass is not given.
bodies::AugmentOptions resolved(const Augment& job);

}  // namespace marey::pipeline::jobs
