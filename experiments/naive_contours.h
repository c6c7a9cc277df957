#pragma once

#include <memory>

#include "experiments/outline_methods.h"

namespace marey::experiments {

/// The peer of `marey experiment contours`: the foreground of OpenCV's MOG2 (shadows removed, opened and closed by 3 × 3 pixels),
/// cut by the boxes of Marey's tracker; the contour of a target is the edge of the largest component in its box.
std::unique_ptr<OutlineMethod> naive_method();

}  // namespace marey::experiments
