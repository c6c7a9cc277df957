// Whether two recordings are of one person with the same markers, by the distances within segments.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"

namespace marey::pipeline::bodies {

/// "A and B are 31 mm farther apart": of the pairs of markers on one segment the one whose median distance differs most, if by more
/// than 15 mm. Nothing if all agree, or no pair is in both.
std::optional<std::string> other_size(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                                      std::span<const solve::skeleton::ObservedMarkers> other);

}  // namespace marey::pipeline::bodies
