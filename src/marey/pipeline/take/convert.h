// One file into another, of whatever format: the input is identified by its content, the output by its ending or by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/edit/operation.h"
#include "marey/format/format.h"
#include "marey/format/match/ground_match.h"
#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::take {

/// Beyond the two files: what neither of them says.
struct ConvertOptions {
  std::string format;                     ///< of the file to be written; empty: its ending says it
  format::ReadOptions read;               ///< but for `up`
  std::optional<format::UpAxis> up;       ///< in the file to be written; in the one that is read, where z is up in the other always
  std::optional<format::UpAxis> from_up;  ///< in the one that is read
  std::optional<edit::FrameRange> frames = {};  ///< these alone, with their numbers and times; nothing: all
  bool labelled = false;                        ///< tracks without a label are omitted
  std::string rig_names = {};                   ///< whose bones .bvh and .glb have; empty: the skeleton's own
  std::string analog;                           ///< a C3D file whose analog channels and events go along into a C3D file
  // Of people on the ground.
  std::string home, away;  ///< teams; empty: as the file says, or by the order of their people
  std::vector<format::match::GroundPeriod> periods;
  format::match::GroundFrame frame;  ///< of the user's own coordinates
  /// Whose ground_from_world says whether y was turned, in place of `frame.y_down`; of points in space the cameras.
  std::string rig;
};

struct ConvertSummary {
  std::string format;   ///< the format written
  std::string counted;  ///< "frames", "places", "cameras"
  std::int64_t count = 0;
  std::vector<std::string> warnings;  ///< one sentence each: what is doubtful in the one, what the other cannot hold
  bool stopped = false;               ///< nothing was written
};

/// Throws WrongFormat where the other format cannot hold what the file holds, or an option has no meaning for it; Error where a
/// file cannot be read or written.
ConvertSummary convert(const std::string& from, const std::string& to, const ConvertOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline::take
