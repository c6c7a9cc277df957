// Where cameras stand, from people who walk before them: no board, no wand.
//
//   1. follow each person in each image (image_people)
//   2. of every two cameras' people, who is the same and by how much one camera was started after the other: the body's shape as it
//      moves up and down agrees at the right shift, and one essential matrix explains all its points (people_pairs)
//   3. grow the rig over the points, each a free one, for several guesses of the focal length (grow_rig)
//   4. adjust all: poses, one focal length a camera under a prior (which is what its file states, where it does), offsets, over a
//   minute also how fast clocks run (clock_drift);
//      outliers put out (bundle)
//   5. put the floor under the feet, upright as people walk, in metres by a height or a distance (people_world)
// A body point that the network places wrongly in every view alike does no harm: it is another point of the same body.
// Cost: dominated by 2 (a RANSAC for each shift that is tried) and 4, linear in the points.
// Reference: Hartley & Zisserman, "Multiple view geometry", 2004; Puwein et al., "Joint camera pose estimation and 3D human pose
// estimation in a multi-camera setup", 2014 (body points as correspondences).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/rig_report.h"
#include "marey/calibrate/wand/wand.h"
#include "marey/core/hooks.h"
#include "marey/core/keypoint_sequence.h"
#include "marey/core/rig.h"

namespace marey::calibrate::people {

/// What a camera saw: frame k was exposed at k / rate_hz + offset_s by the rig's clock, as far as that is known.
struct PeopleCamera {
  KeypointSequence sequence;
  double rate_hz = 0;
  std::optional<double> focal_px = {};  ///< what the camera's file states, right to about a tenth; for cameras without a lens
};

struct PeopleInput {
  Rig rig;  ///< sizes; lenses and offsets where known
  std::vector<PeopleCamera> cameras;
};

struct PeopleOptions {
  std::optional<double> height;                 ///< of the people, m, if all are as tall
  std::optional<wand::KnownDistance> distance;  ///< of two cameras
  double max_offset_s = 0.5;  ///< the largest that is searched, of cameras of which the rig has none; 0: they run together
  std::uint64_t seed = 1;
};

struct PeopleRig {
  Rig rig;  ///< z = 0 is the floor, the origin below the middle of where people were; rates by the first camera's clock
  RigReport report;
  int people = 0;                  ///< seen by two cameras
  double height = 0;               ///< of the one most seen, by the scale that was taken, m
  std::vector<std::string> notes;  ///< what was decided, and what the user should know
};

/// Throws Error, with the cause and what to do: fewer than two cameras with people, no person seen by two, cameras in one place,
/// people who stand still; Stopped.
PeopleRig calibrate_people(const PeopleInput& input, const PeopleOptions& options = {}, const Hooks& hooks = {});

}  // namespace marey::calibrate::people
