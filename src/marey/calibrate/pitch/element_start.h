// Where a camera that sees labelled elements of the pitch may be aimed, before anything is refined.
//
// Where two labelled elements cross, a place of the pitch has a pixel. For an assumed place of the camera, two crossings give the
// rest: the angle between them the focal length, then pan, tilt and roll (the two-point start of PTZ cameras: Chen, Zhu &
// Little, WACV 2018). All pairs are tried from places where main cameras stand, and evaluated by all labelled points with a
// distance that is cut off, so that a wrong name costs no more than itself. With fewer than two crossings pan, tilt and focal
// length are searched on a grid.
#pragma once

#include <span>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/pitch/element_residual.h"

namespace marey::calibrate::pitch {

/// The labels with pixels in half image widths from the middle, beside the elements' shapes.
struct ElementSight {
  int element = 0;
  geometry::PitchElement model;
  std::vector<Vector<2>> points;
  Vector<2> first = Vector<2>::Zero(), last = Vector<2>::Zero();  ///< the two that are farthest apart
};

/// `elements` of the pitch; labels without a point are omitted.
std::vector<ElementSight> sights_of(std::span<const geometry::LabelledElement> labels, const geometry::PitchSize& pitch,
                                    cv::Size size);

/// Mean over the elements of the mean squared distance of their points, each no more than `reach`², half image widths².
double cut_off_cost(const ElementView& view, std::span<const ElementSight> sights, double reach);

/// The best starts from these places (m), at most `count`, that differ from each other; the best first.
std::vector<ElementView> element_starts(std::span<const ElementSight> sights, std::span<const Vector<3>> locations,
                                        std::size_t count);

}  // namespace marey::calibrate::pitch
