#pragma once

#include <span>
#include <vector>

#include "marey/calibrate/line_placement.h"
#include "marey/calibrate/wand/wand_marks.h"

namespace marey::calibrate::wand {

/// One camera's marks through time.
struct MarkTrack {
  std::vector<MarkFrame> frames;  ///< in order of time
  double period_s = 0;            ///< between frames: the shortest that is common
  double offset_s = 0;            ///< added to the camera's times gives the rig's
};

/// A marker's pixel at an instant, and how it moves there.
struct MarkSample {
  Vector<2> pixel = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();  ///< px/s; 0 where the neighbouring frames do not specify
};

using MarkSamples = std::array<std::optional<MarkSample>, MarkerLine::maximum>;

/// Weights of four evenly spaced values for the cubic through them, at `u` in [0, 1] between the second and the third.
std::array<double, 4> cubic_weights(double u);

/// The period of frames at these times; 0 for fewer than two.
double period_of(std::span<const BlobFrame> frames);

/// The marks at an instant of the rig's clock: those of the frame then, or where it falls between frames a cubic through the four
/// round it (an error of a hundredth of a pixel for a wand at 10 m/s² of acceleration); nothing if one of them is missing.
MarkSamples sample_at(const MarkTrack& track, double time_s);

/// The instants at which the cameras are compared: all frames' times where the cameras run synchronised, else those of the first
/// camera with the longest period.
std::vector<double> instants_of(std::span<const MarkTrack> tracks);

/// All samples that show every one of the `markers`, by instant and camera.
MarkTable table_of(std::span<const MarkTrack> tracks, std::span<const double> instants, std::size_t markers);

}  // namespace marey::calibrate::wand
