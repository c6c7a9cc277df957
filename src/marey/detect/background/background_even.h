#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/detect/background/background_shadow.h"

namespace marey::detect::background {

/// Samples of one scene as they would be in one light and before a camera at rest: brought back to the places of one of them, by
/// whole pixels, and each part brought to its light. Nothing if they agree with one another no better for it. `black` is the
/// level of luma's black; all samples are of one size.
std::optional<std::vector<FramePlanes>> evened_out(std::span<const FramePlanes> samples, int black);

}  // namespace marey::detect::background
