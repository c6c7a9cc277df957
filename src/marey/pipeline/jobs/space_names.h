// Names of markers in space, and the skeleton that is solved from them: options of reconstruction and of live runs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/pipeline/jobs/option.h"
#include "marey/pipeline/markers/markers_in_space.h"

namespace marey::pipeline::jobs {

/// Files; empty: none.
struct SpaceNames {
  std::string labels, set, skeleton;
};

/// --labels, --marker-set, --skeleton.
void add_name_rows(Table& table, SpaceNames& names);
/// --marker-set and --skeleton alone.
void add_set_rows(Table& table, SpaceNames& names);

/// Reads the files into `options`. Throws Error if one cannot be read, or the set and the skeleton have no marker in common.
void set_names(const SpaceNames& names, markers::MarkersInSpaceOptions& options, std::vector<std::string>& warnings);

/// Null without a path. Throws Error if the file is not a set, or `skeleton` has none of its markers.
std::shared_ptr<const LearnedMarkers> learned_set_of(const std::string& path, const Skeleton* skeleton);
/// Null without a path.
std::shared_ptr<const Skeleton> skeleton_of(const std::string& path, std::vector<std::string>& warnings);

}  // namespace marey::pipeline::jobs
