// Whether two recordings are of one person with the same markers, by the distances within segments.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"

namespace marey::pipeline::bodies {

/// "A and B are 31 mm farther apart": of the pairs of markers on one segment the one whose median distance differs most, if by more
/// than 15 mm. Nothing if all agree, or no pair is in both.
std::optional<std::string> other_size(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                                      std::span<const solve::skeleton::ObservedMarkers> other);

/// Markers that sit elsewhere on their segments in the other recording: without them no pair differs by more than that. The fewest
/// that do, those first whose pairs differ most.
std::vector<std::size_t> moved_markers(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                                       std::span<const solve::skeleton::ObservedMarkers> other);

}  // namespace marey::pipeline::bodies
