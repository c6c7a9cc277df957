// Plug-in Gait's markers of a recording, and what is known of the person; and the skeleton of a person who stands still.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/gait/conventional_model.h"
#include "marey/analyse/gait/gait_events.h"
#include "marey/core/hooks.h"
#include "marey/core/skeleton.h"
#include "marey/format/format.h"

namespace marey::pipeline {

namespace gait = analyse::gait;

/// By row, one an instant from the first on. 0, 0, 0 is a marker that is missing; a subject's name before a label is left out.
struct GaitMarkers {
  double rate_hz = 0, begin_s = 0;
  std::vector<gait::MarkerPlaces> rows;
  std::vector<std::string> warnings;

  gait::MarkerPath path(std::string_view label) const {
    gait::MarkerPath path(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (const auto found = rows[r].find(label); found != rows[r].end()) path[r] = found->second;
    }
    return path;
  }
};

GaitMarkers read_gait_markers(const std::string& path, const std::optional<format::UpAxis>& up, const Hooks& hooks);

/// Means over a standing trial. Throws Error, with `name` for the file, where the person moves: a marker wanders by more than 3 cm.
gait::MarkerPlaces standing_places(const GaitMarkers& markers, const std::string& name);

/// Where the static trial is of another person, or the markers were put on anew: the pair of one segment's markers that lies most
/// differently far apart in the walk. Nothing where all pairs agree.
std::optional<std::string> other_person(const gait::MarkerPlaces& standing, const GaitMarkers& walk);

/// What Vicon keeps of a person in its C3D files, where `subject` does not have it.
void take_measures(const std::string& path, gait::GaitSubject& subject);

/// How the feet stood in Vicon's own static trial, where a C3D file says so (PROCESSING, StaticPlantFlex): so far is the sole's
/// line above the one from ankle to toe.
void take_soles(const std::string& path, gait::GaitSubject& subject);

/// The human skeleton of a person who stands still, with Plug-in Gait's markers, calibrated to it. Throws Error where the pelvis is
/// not known.
Skeleton human_from_static(const std::string& path, const std::optional<format::UpAxis>& up, const Hooks& hooks);

}  // namespace marey::pipeline
