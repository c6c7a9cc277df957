// The white lines of a pitch in an image of the empty ground, sought where a camera that is nearly right expects them.
//
// Across each expected line, every quarter of a metre along it, brightness is read along the normal; peaks as wide as the paint
// should be there are candidates. A touchline with lettering beside it shows two of them, a shadow's edge none. What belongs to the
// line is decided along its whole length: the candidates must lie on one smooth curve beside the expected line (a parabola
// in the offset, found by consensus), since a camera nearly right is wrong smoothly. Sub-pixel places come from the peak's
// parabola. Cost: samples × reach; a pitch filling a large image gives some thousand samples.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "marey/calibrate/pitch/pitch_camera.h"
#include "marey/core/geometry.h"
#include "marey/geometry/ground_view.h"
#include "marey/geometry/pitch.h"

namespace marey::calibrate::pitch {

/// `luma`: CV_8UC1, people not in it (a median over time). `view` has a whole camera. `lines` in the world, m, on its ground.
/// `reach`: how far from where it is expected a line may be, px where the pitch is far away, 3 cm each near by. Lines that are not
/// seen, or not for a quarter of what is in the image, give no sighting.
std::vector<LineSighting> find_lines(const cv::Mat& luma, const GroundView& view, const std::vector<geometry::PitchLine>& lines,
                                     double reach);

}  // namespace marey::calibrate::pitch
