#pragma once

#include <opencv2/core/types.hpp>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/core/rig.h"

namespace marey::calibrate::wand {

/// The camera's lens, or where it is not known a plain one with a focal length of `guess` times the image's longer side.
geometry::Lens starting_lens(const RigCamera& camera, double guess);

/// How far a lens that was guessed may move while the rig grows: its focal length, and a little of its barrel.
bundle::LensFreedom growing_lens();

/// The estimate of a lens that is not known: focal length, principal point and barrel, with what all lenses have in common
/// as knowledge beforehand (square pixels, a principal point near the middle).
bundle::LensFreedom estimated_lens(cv::Size size);

/// What may be improved of a lens that was given.
bundle::LensFreedom refined_lens(cv::Size size);

}  // namespace marey::calibrate::wand
