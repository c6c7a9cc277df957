// The edits that give each person one track under one name, from the identities found.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/core/recording.h"
#include "marey/pipeline/identify/people.h"
#include "marey/pipeline/take/edit_take.h"

namespace marey::pipeline::identify {

struct NamedPaths {
  std::vector<take::EditRequest> edits;
  std::vector<std::optional<TrackId>> tracks;  ///< of each path the track it is once the edits are done; nothing: it has no place
  std::int64_t excluded = 0;                   ///< places that the edits delete, since they belong to no person
  std::vector<double> known_s;                 ///< for this long a person is reported to be of that path
};

/// `born` is the first id that no track of the take has had.
NamedPaths named_paths(const track::ground::offline::GroundIdentities& found, const TrackedPeople& people,
                       const Recording& recording, const std::vector<SquadMember>& squads, TrackId initiated);

/// A name as an edit is given it.
std::string quoted_name(const std::string& name);

}  // namespace marey::pipeline::identify
