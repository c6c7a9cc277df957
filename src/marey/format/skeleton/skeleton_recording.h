// A skeleton's motion as a recording: joints as points, bones as bodies with their poses.
#pragma once

#include <memory>
#include <string>

#include "marey/format/format.h"
#include "marey/format/skeleton/skeleton_file.h"

namespace marey::format::skeleton {

/// Points are the joints by their names, and the ends of bones without children as "NAME.end"; all are `solved`. Bodies are the
/// segments. A skeleton without motion stands in one frame as it rests, with a warning. Throws Error, with `path` for the file,
/// where joints are this many beside what moves that a small file would make hours of work.
std::unique_ptr<FileReader> recording_of(SkeletonFile file, const std::string& path);

/// What `read_skeleton` is reported of a file that is read as a recording.
inline SkeletonOptions skeleton_options(const ReadOptions& how) {
  return {.unit_m = how.skeleton_unit_m, .up = how.skeleton_up, .rate_hz = how.amc_rate_hz};
}

/// The .asf that an .amc file's bones are in: beside it, of its name or its beginning (01_02.amc: 01.asf), or the only one there.
/// Throws Error if it does not exist.
std::string asf_for(const std::string& amc);

}  // namespace marey::format::skeleton
