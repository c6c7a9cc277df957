// Which of a view's blobs are the wand's markers.
//
// Three markers on a line stay on a line in every view (its lens undone), and the middle one divides it by a ratio that perspective
// shifts only as far as the wand's ends differ in distance. Every three blobs are tried; a view counts where exactly one triple,
// in one order, passes. Of a single light, or a wand of two markers, a view counts where it shows exactly this many. Blobs that
// stay in one place through much of the recording are lamps and reflections, and are omitted first. Later, when the cameras are
// known, `match_marks` finds what this missed: it searches where the wand must be.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/marker_line.h"
#include "marey/core/geometry.h"
#include "marey/geometry/lens.h"

namespace marey::calibrate::wand {

/// The blobs of one camera in one frame.
struct BlobFrame {
  double time_s = 0;             ///< by the camera's own clock
  std::vector<Vector<2>> blobs;  ///< px
};

struct MarkFrame {
  double time_s = 0;
  Marks marks;
};

/// The frames of one camera in which the wand was identified. `lens`, where it is known, straightens the lines; `size` of the
/// image. Frames come in order of time, and so does the result. A reversible wand's ends are in any order.
std::vector<MarkFrame> find_marks(std::span<const BlobFrame> frames, const MarkerLine& wand,
                                  const std::optional<geometry::Lens>& lens, cv::Size size);

/// Of the blobs, those nearest to where the markers should be, within `gate_px`. No blob is taken twice.
Marks match_marks(const BlobFrame& frame, const Marks& expected, double gate_px);

}  // namespace marey::calibrate::wand
