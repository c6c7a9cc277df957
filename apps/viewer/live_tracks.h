#pragma once

#include <map>
#include <optional>
#include <vector>

#include "marey/core/instant.h"

#include "stored_recording.h"

namespace marey::viewer {

/// The tracks of a live run, as its page lists them: those with a name, and those without while they are there. Memory is bounded:
/// an unnamed track is dropped once it was absent for `kForgetS` and there are more than `kMaxUnnamed` of them.
class LiveTracks {
 public:
  static constexpr std::size_t kMaxUnnamed = 500;
  static constexpr double kForgetS = 60;

  void clear() { *this = LiveTracks(); }

  /// Whether the page has to be reported: a track or a name is new, or the targets have left the part of the world that was shown.
  bool add(const Instant& instant);

  std::vector<TrackName> names() const;

  /// The bounding box of the positions that were measured so far, m or px; empty before the first.
  const std::optional<Extent>& extent() const { return extent_; }

 private:
  struct Listed {
    TrackName name;
    Timestamp last{};
  };

  bool list(const Instant& instant);
  bool extend(const Instant& instant);
  void forget(Timestamp now);

  std::map<TrackId, Listed> tracks_;
  std::optional<Extent> extent_;
  std::optional<Extent> reported_;  ///< the extent when `add` was true last
};

}  // namespace marey::viewer
