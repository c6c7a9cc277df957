// Names for markers in space: a set is learned once from recordings in which they have names, then other recordings get them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/solve/labels/label_recording.h"
#include "marey/solve/labels/learn_markers.h"

namespace marey::pipeline::markers {

/// Points whose labels are of these patterns are omitted: names, in which * stands for any letters. Throws Error if a file
/// cannot be read or written, holds no such set, or a pattern fits no label.
LearnedMarkers learn_labels(const std::vector<std::string>& recordings, const std::string& out,
                            const solve::labels::LearnOptions& options, const std::vector<std::string>& exclude = {},
                            std::vector<std::string>* warnings = nullptr);
/// What is to be said of the set besides: points that are not markers.
std::vector<std::string> warnings_of(const LearnedMarkers& learned);

/// A sentence if `set` ("the set FILE") is probably of another person: by how far rigid distances are off
/// (solve::labels::Labelled), and how many of its markers were found.
std::optional<std::string> set_misfit(const std::string& set, double misfit, double misfit_m, std::size_t found,
                                      std::size_t markers);

struct LabelSummary {
  std::vector<solve::labels::MarkerHealth> health;
  std::vector<solve::labels::Unnamed> unnamed;
  std::int64_t instants = 0, points = 0, named = 0;  ///< points that were measured or filled; of these with a name now
  std::int64_t accepted = 0;                         ///< pieces that got the name that fits them best all the same
  std::int64_t renamed = 0;                          ///< segments of tracks that had another name of the set
  double scale = 1;
  double misfit = 0;  ///< how far rigid distances are off, against the values of the subject that taught: about 1
  std::vector<std::string> warnings;
};

/// Names the markers of a recording by a set (set.toml) and writes it: a track for each name, and what has none. Whatever its
/// tracks were called before counts nothing. Tracks of the patterns in `exclude` get no name and stay as they are. Pieces that
/// stay without a name get the best one where it is of `accept`, or that is "all" (solve/labels/accept_suggestions.h). Throws Error
/// where a file cannot be read or written, the set is not in it, or a name of `accept` is not one of the set's.
LabelSummary label_recording(const std::string& recording, const std::string& set, const std::string& out,
                             const solve::labels::LabelOptions& options, const Hooks& hooks = {},
                             const std::vector<std::string>& exclude = {}, const std::vector<std::string>& accept = {});

}  // namespace marey::pipeline::markers
