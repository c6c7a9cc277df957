// The columns of a chunk's tables, as the writer binds and the reader asks for them (docs/take.md).
#pragma once

#include <array>

#include "marey/core/recording.h"

namespace marey::format::take {

/// In the order of the table's columns; boxes are kept exactly, as positions are.
struct OptionalField {
  TrackColumns::Optional column;
  bool exactly;
};
constexpr std::array<OptionalField, TrackColumns::kOptionals> kOptionalFields{{{TrackColumns::Optional::velocity, false},
                                                                               {TrackColumns::Optional::covariance, false},
                                                                               {TrackColumns::Optional::score, false},
                                                                               {TrackColumns::Optional::box, true},
                                                                               {TrackColumns::Optional::residual_px, false},
                                                                               {TrackColumns::Optional::residual_m, false}}};
enum SampleField {
  sample_id,
  sample_rows,
  sample_at,
  sample_x,
  sample_y,
  sample_z,
  sample_provenance,
  sample_cameras,
  sample_first_optional,
  sample_outline = sample_first_optional + TrackColumns::kOptionals,
  sample_keypoints
};
enum PosesField { poses_id, poses_rows, poses_at, poses_pose, poses_residual, poses_covariance, poses_tracked, poses_other };
enum ObservedField {
  observed_id,
  observed_rows,
  observed_at,
  observed_x,
  observed_y,
  observed_sigma,
  observed_area,
  observed_track
};

/// Older takes have no keypoints.
constexpr const char* kSampleFields =
    "id, rows, at, x, y, z, provenance, cameras, velocity, covariance, score, box, residual_px, residual_m, outline";

}  // namespace marey::format::take
