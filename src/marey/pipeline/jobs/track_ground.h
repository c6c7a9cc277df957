// `marey track --ground` as a value: people, and the ball, on the ground that the cameras of a rig see.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/pipeline/jobs/detection_rows.h"
#include "marey/pipeline/people/ground/track_ground.h"

namespace marey::pipeline::jobs {

/// The part of the ground that counts, and data association: of `marey track --ground` and `marey live --ground`.
struct GroundPart {
  std::string size, area, teams, association;
  std::optional<double> margin;
};

/// --size, --area, --margin, --teams, --association.
void add_ground_rows(Table& table, GroundPart& ground);

struct TrackGround {
  std::string rig_name = {};                             ///< for messages
  people::ground::GroundOutput output = {};              ///< `tracks` is the front end's
  std::string filter = {};                               ///< by name; empty: the default one, whose noise is learned
  std::optional<filter::FilterOptions> own_filter = {};  ///< of a caller's, in place of a named one
  PeopleDetection detection = {};
  GroundPart ground = {};
  bool ball = false;
  people::ground::PeopleOnGroundOptions options = {};  ///< rows without dependent defaults are bound to these
};

Table table_of(TrackGround& job);

/// The only place where defaults of this job depend on other options or on the rig. A filter that was chosen keeps its noise.
/// Association: gnn if `live`, which cannot wait for later decisions, otherwise mht, replaced by gnn if the recording has
/// detections alone and its cameras agree. A rig that was calibrated on a pitch has a pitch of the standard size unless a size or
/// an area was given. Throws WrongOption for options that exclude each other.
people::ground::PeopleOnGroundOptions resolved(const TrackGround& job, const Rig& rig);

}  // namespace marey::pipeline::jobs
