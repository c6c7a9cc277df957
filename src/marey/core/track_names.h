#pragma once

#include <map>
#include <span>
#include <string>

#include "marey/core/instant.h"

namespace marey {

/// The names of tracks, as instants report them.
class TrackNames {
 public:
  void add(std::span<const TrackName> named) {
    for (const TrackName& name : named) names_[name.id] = name;
  }

  /// Empty if the track has none.
  const std::string& label(TrackId id) const { return of(id).label; }
  const std::string& team(TrackId id) const { return of(id).team; }
  const TrackName& of(TrackId id) const {
    static const TrackName none;
    const auto found = names_.find(id);
    return found != names_.end() ? found->second : none;
  }
  /// The label, or else the number.
  std::string shown(TrackId id) const { return label(id).empty() ? std::to_string(number(id)) : label(id); }

 private:
  std::map<TrackId, TrackName> names_;
};

}  // namespace marey
