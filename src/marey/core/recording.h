// The one result of every job: where everything was, when, how well that is known, and how it was found out.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/rig.h"

namespace marey {

/// Whose axes a recording's positions are in. A function that needs one refuses the others with a sentence; a change of frame makes
/// a new recording.
struct FrameOfReference {
  enum class Kind : std::uint8_t {
    image,        ///< px of one camera's pictures, y down
    ground,       ///< m on the ground in the rig's right-handed world, z up
    user_ground,  ///< m on the ground as the user has it: `Rig::ground_from_world` was applied
    space,        ///< m in the rig's right-handed world, z up
  };

  Kind kind = Kind::space;
  std::optional<CameraId> camera;  ///< of `image`, where the rig has several

  int dimensions() const { return kind == Kind::space ? 3 : 2; }
  bool metric() const { return kind != Kind::image; }
  bool operator==(const FrameOfReference&) const = default;
};

/// "px of camera 2's pictures", "m on the ground", …: for sentences to the user.
std::string to_string(const FrameOfReference& frame);

/// How a recording was made, so that it can be made again. No time of day, host, thread count or absolute path: the same input with
/// the same options gives the same bytes.
struct MadeBy {
  struct Input {
    std::string name;  ///< without its folder
    std::string hash;  ///< of its size, first and last MiB; empty where it is no regular file
    bool operator==(const Input&) const = default;
  };
  std::string program;                         ///< "marey track" and its version, or the system that a file came from
  std::map<std::string, std::string> options;  ///< by name, as given and as defaulted
  std::vector<Input> inputs;
  bool operator==(const MadeBy&) const = default;
};

/// What is known of a recording before its first instant.
struct RecordingHeader {
  std::string name;         ///< free text; by default the file's
  std::string recorded_at;  ///< ISO 8601, UTC; empty where unknown
  FrameOfReference frame;
  double rate_hz = 0;      ///< instants a second, positive: the median step, where the file does not tell
  std::optional<Rig> rig;  ///< the cameras with their sources; nothing where a file brings positions alone
  MadeBy made_by;
  bool smoothed = false;  ///< a second pass has smoothed positions and velocities: who measures does not smooth again
};

/// What was changed by hand or by a program after the recording: one operation, which is replayed over what was recorded. Edits
/// form a tree; the recording's head says which of them count, so that undoing moves the head.
struct Edit {
  std::int64_t id = 0;                 ///< positive
  std::optional<std::int64_t> parent;  ///< nothing for the first of a branch
  std::string operation;               ///< "rename", "swap", …; "note" for what older takes have
  std::string payload;                 ///< JSON
  bool operator==(const Edit&) const = default;
};

}  // namespace marey
