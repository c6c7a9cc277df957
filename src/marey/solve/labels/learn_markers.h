// A marker set out of recordings in which its markers have their names.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/core/learned_markers.h"
#include "marey/core/recording.h"

namespace marey::solve::labels {

struct LearnOptions {
  std::vector<std::string> labels;  ///< those that belong to the set; none: all that have names
  bool as_far_as_there = false;     ///< those of `labels` that no recording has are omitted; else they are an error
  bool scaled = false;              ///< the recordings are of subjects of several sizes: each is brought to their mean size first
};

/// All recordings count alike, however long. A prefix "SUBJECT:" that all labels of a recording share is omitted. Throws Error
/// where a label is missing in all of them, two tracks of a recording have one, fewer than four markers are there, or barely any
/// two are seen together, or all lie in one line.
LearnedMarkers learn_markers(std::span<const Recording> recordings, const LearnOptions& options);

/// Whether all markers of the set lie in one plane, to 10 mm.
bool is_flat(const LearnedMarkers& learned);

/// Those of the set that lie nearer to another than two markers do, on the mean: points that a program computed among them (joints'
/// centres, axes' ends). Of the real takes that were measured no two markers ever came nearer than 19 mm.
std::vector<std::string> too_near_for_markers(const LearnedMarkers& learned);

}  // namespace marey::solve::labels
