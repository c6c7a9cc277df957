// Names that a user gives to tracks while they are followed: from then on every sink has them, in place of the run's own.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "marey/core/instant.h"
#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::markers {

class TrackNaming {
 public:
  /// From any thread. An empty label gives the track back the name that it had. Throws Error if there is no such track, or
  /// another one that is seen now has this name.
  void name(TrackId track, const std::string& label);

  /// From the run's thread: what it knows now, with the user's names. They hold until the next call. Of two that are seen at the
  /// same time and have one name, the one that the user gave it to last keeps it.
  std::span<const Instant> enter(std::span<const Instant> instants);

 private:
  struct Given {
    std::string label;
    int order = 0;  ///< the later, the larger
  };
  const std::string& label_of(TrackId track) const;
  void take_name(TrackId track);
  void resolve_duplicates(const Instant& instant);

  std::mutex mutex_;
  std::map<TrackId, TrackName> own_;  // of every track that was there, as the run calls it
  std::map<TrackId, Given> given_;    // by the user
  int rotations_ = 0;
  std::set<TrackId> present_, fresh_;  // in the newest instant; named again since
  std::vector<Instant> changed_;
};

/// The stage, its tracks named by hand; the stage alone where `naming` is null.
std::unique_ptr<corridor::Stage> with_naming(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<TrackNaming> naming);

}  // namespace marey::pipeline::markers
