// The job from a rig's cameras to every person on the ground.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/analyse/teams.h"
#include "marey/core/rig.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/ground/people_on_ground.h"

namespace marey::pipeline::people::ground {

/// Where the results go; what is empty is not made.
struct GroundOutput {
  std::string tracks = {};  ///< a recording that is written as it is made: in `format`, else that of its ending, else CSV
  std::string format = {};  ///< a name of the register
  std::string boxes_of =
      {};  ///< a camera: `tracks` then is MOT text whatever `format` is, the boxes in that view by that camera's own frames
  std::string blur = {};        ///< "faces": heads are made unrecognisable in `overlays`
  std::string copies = {};      ///< a folder for the same videos with faces blurred and nothing drawn
  std::string overlays = {};    ///< a folder: <camera>.mp4, a video of each camera that has images
  std::string numbers = {};     ///< a CSV file of people's shirt numbers (number_sink.h)
  std::string pitch_view = {};  ///< a video of the ground from above
};

struct GroundSummary : corridor::Summary {
  std::vector<analyse::Teams::Team> teams;
};

/// Follows every person on the ground that the rig's cameras observe and writes where they were in the coordinates of the rig's
/// user. Where the rig does not specify when its cameras were started, that is found out first. The same input gives the same
/// output, bit for bit. Throws Error if a camera cannot be read or is not calibrated, or an output not written; nothing
/// half-written stays behind.
GroundSummary track_ground(const Rig& rig, const GroundOutput& output, const PeopleOnGroundOptions& options = {},
                           const Hooks& hooks = {});
/// The same, into `sinks` besides `output`, whose `tracks` may be empty.
GroundSummary track_ground(const Rig& rig, const GroundOutput& output, std::vector<std::unique_ptr<Sink>> sinks,
                           const PeopleOnGroundOptions& options, const Hooks& hooks);

/// The files in `output.overlays`; none if it is empty.
std::vector<std::string> overlays_of(const Rig& rig, const GroundOutput& output);

}  // namespace marey::pipeline::people::ground
