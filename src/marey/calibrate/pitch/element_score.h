// How well a camera explains labelled elements of a pitch, as SoccerNet's camera calibration counts.
//
// Every element is projected and cut at the image's edge. One that is labelled and projected is right where every labelled point
// lies within the tolerance of it, else false; projected alone false, labelled alone missed. JaC = right / (right + false +
// missed). The better of the pitch as it is and turned by half a turn counts. Reference: sn-calibration, `evaluate_camera.py`;
// Magera et al., "SoccerNet game state reconstruction", CVPR workshops 2024.
#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/pitch_elements.h"

namespace marey::calibrate::pitch {

struct ElementScore {
  int right = 0, wrong = 0, missed = 0;
  double jaccard() const { return right + wrong + missed > 0 ? static_cast<double>(right) / (right + wrong + missed) : 0; }
};

/// px, of each labelled point from the projected element; nothing if the element is not in the camera's image.
std::vector<std::optional<double>> element_distances(const geometry::Camera& camera, const geometry::LabelledElement& label,
                                                     const geometry::PitchSize& pitch);

/// `tolerance` in px of the camera's image.
ElementScore score_elements(const geometry::Camera& camera, std::span<const geometry::LabelledElement> labels,
                            const geometry::PitchSize& pitch, double tolerance);

}  // namespace marey::calibrate::pitch
