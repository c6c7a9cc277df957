#include "marey/pipeline/jobs/space_names.h"

#include <algorithm>

#include "marey/format/bodies/label_set_file.h"
#include "marey/format/motion/marker_set.h"
#include "marey/pipeline/markers/skeleton_in_space.h"

namespace marey::pipeline::jobs {

void add_set_rows(Table& table, SpaceNames& names) {
  table.input_file("marker-set", names.set,
                   "label the markers, frame by frame, by a set that \"marey label learn\" made: set.toml");
  table.input_file("skeleton", names.skeleton,
                   "solve the pose of this skeleton from the labelled markers in each frame: skeleton.toml or .osim, fitted to the "
                   "person (marey solve --write-skeleton)");
}

void add_name_rows(Table& table, SpaceNames& names) {
  table.input_file("labels", names.labels,
                   "the markers' labels: CSV label,x,y,z of their positions at the beginning (m), or one label per line, by "
                   "increasing x");
  add_set_rows(table, names);
}

std::shared_ptr<const LearnedMarkers> learned_set_of(const std::string& path, const Skeleton* skeleton) {
  if (path.empty()) return nullptr;
  auto set = std::make_shared<const LearnedMarkers>(format::bodies::read_label_set(path));
  if (skeleton == nullptr) return set;
  const auto is_marker = [&](const std::string& label) {
    return std::any_of(skeleton->markers.begin(), skeleton->markers.end(),
                       [&](const SkeletonMarker& marker) { return marker.label == label; });
  };
  if (std::none_of(set->labels.begin(), set->labels.end(), is_marker))
    throw Error("{}: none of its names is a marker of the skeleton {}: the set has {} …, the skeleton {} …", path, skeleton->name,
                set->labels.front(), skeleton->markers.front().label);
  return set;
}

std::shared_ptr<const Skeleton> skeleton_of(const std::string& path, std::vector<std::string>& warnings) {
  return path.empty() ? nullptr : markers::skeleton_with_markers(path, warnings);
}

void set_names(const SpaceNames& names, markers::MarkersInSpaceOptions& options, std::vector<std::string>& warnings) {
  if (!names.labels.empty()) options.set = format::motion::read_marker_set(names.labels);
  options.skeleton = skeleton_of(names.skeleton, warnings);
  options.learned_set = learned_set_of(names.set, options.skeleton.get());
}

}  // namespace marey::pipeline::jobs
