// Measurements of a walk, as C3D contains them: angles of joints among the points, strikes and offs as events.
#pragma once

#include <optional>
#include <string>

#include "marey/pipeline/bodies/measure_gait.h"

namespace marey::pipeline::bodies {

/// Angles three by three in degrees, called as Plug-in Gait calls them where they mean the same; strikes and offs by side.
format::MotionFindings findings_of(const GaitMeasure& measure);

/// The recording again, with its measurements. Axes stay as they are in the recording. Throws Error if it cannot be
/// written.
void write_gait_c3d(const std::string& path, const std::string& recording, const std::optional<format::UpAxis>& up,
                    const GaitMeasure& measure);

}  // namespace marey::pipeline::bodies
