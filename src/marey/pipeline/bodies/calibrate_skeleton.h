// A skeleton fitted to the person in recordings, and written as a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/format/format.h"
#include "marey/pipeline/bodies/solve_skeleton.h"
#include "marey/solve/skeleton/calibrate.h"

namespace marey::pipeline::bodies {

/// Throws Error if the file holds no points in space.
std::unique_ptr<format::FileReader> open_markers(const std::string& path, const SolveOptions& options);

/// From the recording and the options' other takes. Markers of a `generic` model have the deviations of `marker_sigmas` on their
/// segments, left and right tied; those of others 10 mm. A static trial shows where joints are straight. Warns of a take of another
/// person, and of a posture that is not upright; markers that it has elsewhere on their segments do not count in it.
solve::skeleton::Calibration calibrate_skeleton(const std::string& recording, const Skeleton& skeleton, bool generic,
                                                const SolveOptions& options, std::vector<std::string>& warnings);

/// skeleton.toml, or by its ending the .osim that `source` is, calibrated. Throws Error if there is no such model, or no
/// calibration.
void write_skeleton_file(const std::string& source, const SolvedRecording& solved, const SolveOptions& options,
                         std::vector<std::string>& warnings);

}  // namespace marey::pipeline::bodies
