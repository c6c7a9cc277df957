#pragma once

#include <string>
#include <vector>

#include "marey/analyse/body_shape.h"
#include "marey/core/hooks.h"

namespace marey::pipeline::take {

/// A figure of one person over a recording.
struct ContourFigure {
  double mean = 0, spread = 0;  ///< over time: mean and standard deviation
  double deviation = 0;         ///< of one measurement: root mean square of what the contours report
  int samples = 0;
};

/// What the contours of one person say. Metres and square metres where the camera sees the ground, else px and px².
struct PersonContours {
  int id = 0;
  std::string label;
  int contours = 0;  ///< in the recording; those that are held, or hidden for more than a quarter, are not measured
  ContourFigure area, width, height, lean, leg_opening;  ///< lean in degrees, to the right of upright
};

struct ContourMeasurement {
  bool metric = false;
  std::vector<PersonContours> people;  ///< by id; those without a contour are omitted
};

struct MeasureContoursOptions {
  std::string rig;     ///< whose first camera took the recording; empty: the recording's own, if it is calibrated
  std::string series;  ///< CSV with a row for each person and instant; empty: none
};

/// Whether a file is a recording in an image, which has contours if any.
bool is_of_image(const std::string& path);

/// Measures the contours of a take into a CSV file with a row for each person. Throws Error if it holds none, or a file cannot be
/// read or written; Stopped.
ContourMeasurement measure_contours(const std::string& take, const std::string& figures, const MeasureContoursOptions& options,
                                    const Hooks& hooks = {});

}  // namespace marey::pipeline::take
