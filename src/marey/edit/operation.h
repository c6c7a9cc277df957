// What can be done to a recording after it was made. Nothing recorded is ever changed: an operation is kept as an edit
// (core/recording.h) and replayed over the recording, so that undoing forgets nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"

namespace marey::edit {

/// Frames by their indices, both ends included.
struct FrameRange {
  static constexpr std::int64_t kToTheEnd = std::numeric_limits<std::int32_t>::max();  // by definition

  std::int64_t first = 0, last = 0;

  bool holds(std::int64_t index) const { return first <= index && index <= last; }
  bool operator==(const FrameRange&) const = default;
};

/// How the place of a marker within a gap is found (fill_gap.h).
enum class FillMethod { spline, rigid, pattern };

/// One gap of one track, with what was decided when it was filled: replaying decides nothing again.
struct FilledGap {
  TrackId track{};
  FrameRange frames;
  FillMethod method{};
  std::vector<TrackId> donors;  ///< of `rigid` and `pattern`: the markers that it is reported by
  double expected_m = 0;        ///< standard deviation of a filled place's distance from the true one, in the middle of the gap
  std::vector<Vector<3>> locations =
      {};  ///< instant by instant, as found when it was decided; empty in edits of before: found again

  bool operator==(const FilledGap&) const = default;
};

struct Operation {
  enum class Kind {
    rename,  ///< tracks[0] is called `label`
    swap,    ///< tracks[0] and tracks[1] exchange what they have within `frames`
    split,   ///< what tracks[0] has from frames->first on becomes `born`, called `label`
    join,    ///< tracks[0] gets what tracks[1] has, which ends
    remove,  ///< what the tracks have within `frames` is omitted
    fill,    ///< `gaps`
    team,    ///< tracks are of the team that `label` is called
    filter,  ///< tracks[i] is smoothed with `cutoffs_hz[i]` within `frames`
    turn,    ///< `body` has its other pose within `frames`, where it has one
  };

  Kind kind{};
  std::vector<TrackId> tracks = {};
  std::optional<FrameRange> frames = {};  ///< nothing: all of them
  std::string label = {};
  std::optional<TrackId> initiated = {};
  std::vector<FilledGap> gaps = {};
  std::vector<double> cutoffs_hz = {};  ///< Hz; of both passes together
  std::optional<BodyId> body = {};

  bool operator==(const Operation&) const = default;
};

/// "rename", "swap", "split", "join", "delete", "fill", "team", "filter", "turn".
std::string_view name_of(Operation::Kind kind);
std::optional<Operation::Kind> kind_named(std::string_view name);
/// "spline", "rigid", "pattern".
std::string_view name_of(FillMethod method);
std::optional<FillMethod> method_named(std::string_view name);

/// As an edit keeps it; id and parent are the caller's.
Edit edit_of(const Operation& operation);

/// Whether an edit says what this version can do: an operation, or a note, which changes nothing.
bool is_known(const Edit& edit);

/// The operation that an edit holds; nothing for a note, and where it is not known. Throws Error if its payload is not what it
/// should be.
std::optional<Operation> operation_of(const Edit& edit);

}  // namespace marey::edit
