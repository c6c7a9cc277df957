// Plug-in Gait's markers of a recording, or another set's in their place, and the person's measures.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "marey/analyse/gait/body_marker_sets.h"
#include "marey/analyse/gait/conventional_model.h"
#include "marey/analyse/gait/gait_events.h"
#include "marey/core/hooks.h"
#include "marey/format/format.h"

namespace marey::pipeline::bodies {

namespace gait = analyse::gait;

inline constexpr double kStandsStillM = 0.03;  ///< that a marker of who stands moves at most

/// By row, one an instant from the first on. 0, 0, 0 is a marker that is missing; a subject's name before a label is omitted.
struct GaitMarkers {
  double rate_hz = 0, begin_s = 0;
  std::int64_t first_index = 0;
  format::UpAxis up = format::UpAxis::z;                   ///< the axis of the file that was taken for up
  format::AuxiliaryData auxiliary = {};                    ///< of a C3D file
  const gait::BodyMarkerSet* set = &gait::plug_in_gait();  ///< rows have what the model calls its labels
  std::vector<gait::MarkerPositions> rows;
  std::vector<std::string> warnings;

  gait::MarkerPath path(std::string_view label) const {
    gait::MarkerPath path(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (const auto found = rows[r].find(label); found != rows[r].end()) path[r] = found->second;
    }
    return path;
  }
};

/// The set that a recording's labels are, subjects' names omitted; `name`, where one is given. Throws Error with the file's name
/// where they are not any, or that one's lack.
const gait::BodyMarkerSet& marker_set_of(const std::string& path, const std::string& name);

/// `most` rows, or all.
GaitMarkers read_gait_markers(const std::string& path, const std::optional<format::UpAxis>& up, const Hooks& hooks,
                              const gait::BodyMarkerSet& set = gait::plug_in_gait(),
                              const std::optional<std::int64_t>& maximum = {});

/// Means over a standing trial. Throws Error, with `name` for the file, where the person moves: a marker wanders by more than 3 cm.
gait::MarkerPositions standing_positions(const GaitMarkers& markers, const std::string& name);

/// Where the markers are at the quietest instant of a motion in which most of them are seen.
struct QuietTimeStep {
  gait::MarkerPositions locations;
  double time_s = 0;     ///< since the first row
  double speed_m_s = 0;  ///< of the markers there, on the mean
  bool stands = false;   ///< for a second about it, of which the places are the means
};
/// Throws Error, with `name` for the file, where there is no marker at all.
QuietTimeStep quietest_time_step(const GaitMarkers& markers, const std::string& name);

/// Where the static trial is of another person, or the markers were put on again: the pair of one segment's markers that lies most
/// differently far apart in the walk. Nothing if all pairs agree.
std::optional<std::string> other_person(const gait::MarkerPositions& standing, const GaitMarkers& walk);

/// Pairs of Plug-in Gait's markers that sit on one segment.
std::span<const std::pair<std::string_view, std::string_view>> rigid_marker_pairs();

/// What Vicon keeps of a person in its C3D files, where `subject` does not have it.
void take_measures(const std::string& path, gait::GaitSubject& subject);

/// Mass (kg) and height (m) of the person that Vicon keeps in its C3D files; nothing in other files.
struct BodySize {
  std::optional<double> mass_kg, height_m;
};
BodySize body_size_in_c3d(const std::string& path);

/// How the feet stood in Vicon's own static trial, where a C3D file says so (PROCESSING, StaticPlantFlex): so far is the sole's
/// line above the one from ankle to toe, and inwards of it (StaticRotOff).
void take_soles(const std::string& path, gait::GaitSubject& subject);

}  // namespace marey::pipeline::bodies
