// `marey solve` as a value: the motion of a skeleton, from labelled markers or body keypoints in space.
#pragma once

#include <string>

#include "marey/pipeline/bodies/solve_skeleton.h"
#include "marey/pipeline/jobs/option.h"

namespace marey::pipeline::jobs {

struct Solve {
  std::string skeleton = {};                   ///< a file; empty: the human skeleton
  std::string up = {};                         ///< y or z; empty: as `resolved` of the recording states
  std::string skeleton_up = "y", bvh_up = {};  ///< by name; empty: y, or as the rig's names have it
  bodies::SolveOptions options = {};           ///< rows without dependent defaults are bound to these
};

Table table_of(Solve& job);

/// Throws WrongOption for options that exclude each other.
bodies::SolveOptions resolved(const Solve& job);

}  // namespace marey::pipeline::jobs
